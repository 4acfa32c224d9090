// Max's weights for W triangles at a time, for one instruction set (triangle_lanes.h). Included by
// max_normals_<set>.cpp alone; nothing here has external linkage but the entry that each defines.
#pragma once

#include "degenerate.h"
#include "max_normals.h"
#include "triangle_lanes.h"

namespace gaussmap {
namespace {

template <int W>
struct CornerNormals {
    Vectors<W> corner[3];  // 0 where the triangle adds nothing
};

// sin α / (|e1| |e2|) times the unit normal is e1 × e2 / (|e1|² |e2|²): no root, one division.
template <int W>
GAUSSMAP_INLINE CornerNormals<W> corner_normals(const double* xyz, const std::int32_t* abc) {
    using Real = typename Lanes<W>::Real;
    const auto a = gather<W>(xyz, abc), b = gather<W>(xyz, abc + 1), c = gather<W>(xyz, abc + 2);
    const auto ab = minus<W>(b, a), ac = minus<W>(c, a), bc = minus<W>(c, b);
    const auto normal = cross<W>(ab, ac);
    const Real ab2 = dot<W>(ab, ab), ac2 = dot<W>(ac, ac), bc2 = dot<W>(bc, bc);
    const Real half_squares = 0.5 * (ab2 + ac2 + bc2);
    const Real huge = Real{} + __DBL_MAX__;
    const Real reciprocal = 1 / (ab2 * ac2 * bc2);
    const Real weight[] = {bc2 * reciprocal, ac2 * reciprocal, ab2 * reciprocal};
    auto usable = (half_squares <= huge) & (dot<W>(normal, normal) > no_area_ratio * (half_squares * half_squares));
    CornerNormals<W> out;
    Real sum{};
    for (int k = 0; k < 3; ++k) {
        Vectors<W>& n = out.corner[k];
        n = {weight[k] * normal.x, weight[k] * normal.y, weight[k] * normal.z};
        sum += n.x + n.y + n.z;
    }
    usable &= sum - sum == Real{};  // all of them are finite
    for (Vectors<W>& n : out.corner) {
        const Real zero{};
        n = {usable ? n.x : zero, usable ? n.y : zero, usable ? n.z : zero};
    }
    return out;
}

template <int W>
inline void run(const double* xyz, const std::int32_t* abc, std::size_t count, double* corners) {
    for (std::size_t f = 0; f < count; f += W) {
        std::int32_t last[3 * W];
        const std::int32_t* indices = abc + 3 * f;
        const int valid = static_cast<int>(count - f < W ? count - f : W);
        if (valid < W) {  // made up to W with copies of the last one
            for (int i = 0; i < 3 * W; ++i) last[i] = abc[3 * (f + i / 3 < count ? f + i / 3 : count - 1) + i % 3];
            indices = last;
        }
        const CornerNormals<W> n = corner_normals<W>(xyz, indices);
        for (int k = 0; k < 3; ++k) {
            // x and y as they lie in memory: of even triangles, then of odd ones.
            const Vectors<W>& v = n.corner[k];
            const typename Lanes<W>::Real xy[] = {evens<W>(v.x, v.y), odds<W>(v.x, v.y)};
            double* out = corners + 9 * f + 3 * k;
            for (int l = 0; l < valid; ++l, out += 9) store_pair(out, pair<W>(xy[l & 1], l / 2)), out[2] = v.z[l];
        }
    }
}

}  // namespace
}  // namespace gaussmap
