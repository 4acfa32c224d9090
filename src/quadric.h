// Sums of squared distances to planes. Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics",
// 1997.
#pragma once

#include <algorithm>
#include <cmath>

#include "vec.h"

namespace gaussmap {

/// Q(p) = pᵀ A p − 2 b·p + c, A symmetric and positive semidefinite.
struct Quadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    Vec3 b;
    double c = 0;

    Quadric& operator+=(const Quadric& q) {
        xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
        b = b + q.b, c += q.c;
        return *this;
    }
    Vec3 times(Vec3 p) const {
        return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z};
    }
    /// Never below 0, whatever the rounding.
    double at(Vec3 p) const { return std::max(0.0, dot(p, times(p) - 2 * b) + c); }
    double trace() const { return xx + yy + zz; }
};

inline Quadric operator+(Quadric a, const Quadric& b) {
    return a += b;
}

/// weight · (n·(x − p))², n not unit: |n|² is part of the weight.
inline Quadric plane_quadric(Vec3 n, Vec3 p, double weight) {
    const double d = dot(n, p);
    const Vec3 m = weight * n;
    return {m.x * n.x, m.x * n.y, m.x * n.z, m.y * n.y, m.y * n.z, m.z * n.z, d * m, d * d * weight};
}

/// Area-weighted quadric of a triangle's plane; none of a triangle without area.
inline Quadric triangle_quadric(Vec3 a, Vec3 b, Vec3 c, double weight) {
    const Vec3 n = cross(b - a, c - a);
    const double twice_area = length(n);
    return twice_area > 0 ? plane_quadric(n, a, weight * 0.5 / twice_area) : Quadric();
}

/// The point of least Q, held to `near` along directions in which Q is flat: minimises Q(x) + pull · trace(A) |x −
/// near|², which needs no decision about the rank of A. `near` itself where A is 0.
inline Vec3 minimizer(const Quadric& q, Vec3 near, double pull) {
    const double t = q.trace();
    if (!(t > 0)) return near;
    // Cholesky factors L D Lᵀ of A + pull t I.
    const double e = pull * t, d0 = q.xx + e, l10 = q.xy / d0, l20 = q.xz / d0;
    const double d1 = q.yy + e - l10 * q.xy, m21 = q.yz - l20 * q.xy, l21 = m21 / d1;
    const double d2 = q.zz + e - l20 * q.xz - l21 * m21;
    const Vec3 g = q.b - q.times(near);
    const double y1 = g.y - l10 * g.x, y2 = g.z - l20 * g.x - l21 * y1;
    const double z = y2 / d2, y = y1 / d1 - l21 * z, x = g.x / d0 - l10 * y - l20 * z;
    const Vec3 p = near + Vec3{x, y, z};
    return finite(p) ? p : near;
}

}  // namespace gaussmap
