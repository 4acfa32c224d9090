// Sums of squared distances to planes, each about its vertex, and the point where such a sum is least. Garland and
// Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997.
//
// About the vertex, the planes of the faces at it have no linear and no constant part: six numbers say it all, and
// nothing cancels, however far from the origin the surface is.
#pragma once

#include "vec.h"

namespace gaussmap {

/// A symmetric matrix, positive semidefinite.
struct Symmetric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    Symmetric& operator+=(const Symmetric& s) {
        xx += s.xx, xy += s.xy, xz += s.xz, yy += s.yy, yz += s.yz, zz += s.zz;
        return *this;
    }
    Symmetric operator+(const Symmetric& s) const {
        return {xx + s.xx, xy + s.xy, xz + s.xz, yy + s.yy, yz + s.yz, zz + s.zz};
    }
    Symmetric& operator*=(double w) {
        xx *= w, xy *= w, xz *= w, yy *= w, yz *= w, zz *= w;
        return *this;
    }
    Vec3 times(Vec3 p) const {
        return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z};
    }
    double trace() const { return xx + yy + zz; }
    /// Adds weight · n nᵀ.
    void add_normal(Vec3 n, double weight) {
        const Vec3 m = weight * n;
        xx += m.x * n.x, xy += m.x * n.y, xz += m.x * n.z, yy += m.y * n.y, yz += m.y * n.z, zz += m.z * n.z;
    }
};

/// (A + e I)⁻¹ by minors. With e a small part of the trace, the point of least xᵀ A x − 2 g·x, held to the origin along
/// directions in which A is flat, needs no decision about the rank of A.
class HeldInverse {
  public:
    HeldInverse(const Symmetric& a, double e) {
        const double xx = a.xx + e, yy = a.yy + e, zz = a.zz + e;
        minors_ = {yy * zz - a.yz * a.yz, a.xz * a.yz - a.xy * zz, a.xy * a.yz - a.xz * yy,
                   xx * zz - a.xz * a.xz, a.xy * a.xz - xx * a.yz, xx * yy - a.xy * a.xy};
        scale_ = 1 / (xx * minors_.xx + a.xy * minors_.xy + a.xz * minors_.xz);
    }
    Vec3 times(Vec3 g) const { return scale_ * minors_.times(g); }
    /// gᵀ (A + e I)⁻¹ g: by how much xᵀ (A + e I) x − 2 g·x falls below 0.
    double energy(Vec3 g) const { return scale_ * dot(g, minors_.times(g)); }

  private:
    Symmetric minors_;
    double scale_;
};

}  // namespace gaussmap
