// Shape operators as symmetric tensors in space: S maps a tangent to the change of the normal along it, and the normal
// to 0, so that |S|² = k1² + k2². Tensors of near points are compared after turning one tangent plane into the other.
#pragma once

#include <cmath>

#include "eigen2.h"
#include "eigen3.h"
#include "frame.h"
#include "height_fit.h"
#include "vec.h"

namespace gaussmap {

inline double squared_norm(const Symmetric3& a) {
    return a.xx * a.xx + a.yy * a.yy + a.zz * a.zz + 2 * (a.xy * a.xy + a.xz * a.xz + a.yz * a.yz);
}

inline void add(Symmetric3& sum, double factor, const Symmetric3& a) {
    sum.xx += factor * a.xx, sum.xy += factor * a.xy, sum.xz += factor * a.xz;
    sum.yy += factor * a.yy, sum.yz += factor * a.yz, sum.zz += factor * a.zz;
}

inline Symmetric3 scaled(double factor, const Symmetric3& a) {
    return {factor * a.xx, factor * a.xy, factor * a.xz, factor * a.yy, factor * a.yz, factor * a.zz};
}

inline Symmetric3 negated(const Symmetric3& a) {
    return {-a.xx, -a.xy, -a.xz, -a.yy, -a.yz, -a.zz};
}

inline Vec3 product(const Symmetric3& a, Vec3 v) {
    return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
            a.xz * v.x + a.yz * v.y + a.zz * v.z};
}

/// factor (a bᵀ + b aᵀ) / 2, added.
inline void add_product(Symmetric3& sum, double factor, Vec3 a, Vec3 b) {
    const double h = 0.5 * factor;
    sum.xx += factor * a.x * b.x, sum.yy += factor * a.y * b.y, sum.zz += factor * a.z * b.z;
    sum.xy += h * (a.x * b.y + a.y * b.x), sum.xz += h * (a.x * b.z + a.z * b.x);
    sum.yz += h * (a.y * b.z + a.z * b.y);
}

/// A tensor of the tangent plane from its entries over the frame's u and v.
inline Symmetric3 in_plane(const Frame& frame, double uu, double uv, double vv) {
    Symmetric3 tensor;
    add_product(tensor, uu, frame.u, frame.u);
    add_product(tensor, 2 * uv, frame.u, frame.v);
    add_product(tensor, vv, frame.v, frame.v);
    return tensor;
}

/// A tensor of the tangent plane across `from`, carried to that across `to` by the smallest rotation that does so.
/// With w = from + to and c = 1 + from·to, a tangent t goes to t − w (w·t) / c, as (from·t) = 0.
inline Symmetric3 carried(const Symmetric3& a, Vec3 from, Vec3 to) {
    const Vec3 w = from + to;
    const double c = 1 / (1 + dot(from, to));
    const Vec3 aw = product(a, w);
    Symmetric3 result = a;
    add_product(result, -2 * c, w, aw);
    add_product(result, c * c * dot(w, aw), w, w);
    return result;
}

/// Principal curvatures of sign · a, across a unit normal.
inline Principal principal(const Symmetric3& a, double sign, Vec3 normal) {
    const Frame frame = frame_about(normal);
    const Vec3 au = product(a, frame.u), av = product(a, frame.v);
    return principal({sign * dot(frame.u, au), sign * dot(frame.u, av), sign * dot(frame.v, av)}, frame);
}

/// What a fitted height field says of the surface over the origin of its frame.
struct SurfaceJet {
    Vec3 normal;
    Symmetric3 tensor;  ///< a sphere seen from outside bends away: positive
};

/// \param c     coefficients of 1, u, v, u², uv, v² with u, v and heights in units of `size`.
/// The second fundamental form over the dual basis of the tangents (1, 0, h_u) and (0, 1, h_v).
template <class Coefficients>
SurfaceJet surface_jet(const Coefficients& c, const Frame& frame, double size) {
    const double p = c[1], q = c[2], w = 1 / std::sqrt(1 + p * p + q * q), factor = -w / size;
    const Vec3 tangent_u = frame.u + p * frame.n, tangent_v = frame.v + q * frame.n;
    const double e = 1 + p * p, f = p * q, g = 1 + q * q, determinant = 1 / (e * g - f * f);
    const Vec3 dual_u = determinant * (g * tangent_u - f * tangent_v),
               dual_v = determinant * (e * tangent_v - f * tangent_u);
    SurfaceJet jet;
    jet.normal = w * (frame.n - p * frame.u - q * frame.v);
    add_product(jet.tensor, 2 * c[3] * factor, dual_u, dual_u);
    add_product(jet.tensor, 2 * c[4] * factor, dual_u, dual_v);
    add_product(jet.tensor, 2 * c[5] * factor, dual_v, dual_v);
    return jet;
}

}  // namespace gaussmap
