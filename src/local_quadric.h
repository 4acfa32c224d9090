// Sums of squared distances to planes, each about its vertex. Garland and Heckbert, "Surface Simplification Using
// Quadric Error Metrics", 1997.
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
    Symmetric operator-(const Symmetric& s) const {
        return {xx - s.xx, xy - s.xy, xz - s.xz, yy - s.yy, yz - s.yz, zz - s.zz};
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

/// L D Lᵀ = A + e I: with e a small part of the trace the point of least xᵀ A x − 2 g·x, held to the origin along
/// directions in which A is flat, needs no decision about the rank of A.
class HeldFactors {
  public:
    HeldFactors(const Symmetric& a, double e) {
        r0_ = 1 / (a.xx + e), l10_ = a.xy * r0_, l20_ = a.xz * r0_;
        const double m21 = a.yz - l20_ * a.xy;
        r1_ = 1 / (a.yy + e - l10_ * a.xy), l21_ = m21 * r1_;
        r2_ = 1 / (a.zz + e - l20_ * a.xz - l21_ * m21);
    }
    /// gᵀ (A + e I)⁻¹ g: by how much xᵀ (A + e I) x − 2 g·x falls below 0.
    double energy(Vec3 g) const {
        const Vec3 y = forward(g);
        return y.x * y.x * r0_ + y.y * y.y * r1_ + y.z * y.z * r2_;
    }
    /// (A + e I)⁻¹ g
    Vec3 solve(Vec3 g) const {
        const Vec3 f = forward(g);
        const double z = f.z * r2_, y = f.y * r1_ - l21_ * z;
        return {f.x * r0_ - l10_ * y - l20_ * z, y, z};
    }

  private:
    /// L⁻¹ g
    Vec3 forward(Vec3 g) const {
        const double y = g.y - l10_ * g.x;
        return {g.x, y, g.z - l20_ * g.x - l21_ * y};
    }

    double r0_, l10_, l20_, r1_, l21_, r2_;  ///< 1 / D, and L below its diagonal
};

}  // namespace gaussmap
