// Smallest principal directions, as principal_normal.h has them, for one instruction set. Part of
// cloud_kernel_<set>.cpp alone; nothing here may have external linkage.
#pragma once

#include "cloud_kernel.h"
#include "real3.h"

namespace gaussmap {
namespace {

/// The upper triangle.
struct RealSymmetric3 {
    Real xx, xy, xz, yy, yz, zz;
};

GAUSSMAP_INLINE Real3 operator*(const RealSymmetric3& m, const Real3& a) {
    return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
            m.xz * a.x + m.yz * a.y + m.zz * a.z};
}

/// Second moments of the points and their neighbours about their mean. Every one weighs 1, or as `principal_normal`
/// has it.
template <bool Weighted>
GAUSSMAP_INLINE RealSymmetric3 moments(const LanePatches& patches, const LaneCounts& counts, int lane) {
    const int last = most(counts, lane);
    const Real count = counted(counts, lane);
    Real all_weights = count + 1, over_h_squared = {};
    if (Weighted) {
        Real farthest = {};
        for (int j = 0; j < last; ++j) farthest = maximum(farthest, squared(load3(patches.d[j], lane)));
        over_h_squared = select(farthest > 0, count / (farthest * (count + 1)), Real{});
        all_weights = all(1);
    }
    Real3 sum = {};
    RealSymmetric3 m = {};
    Real number = {};
    for (int j = 0; j < last; ++j, number += 1) {
        const Real3 d = load3(patches.d[j], lane);
        Real3 wd = d;
        if (Weighted) {
            const Real rest = 1 - squared(d) * over_h_squared, w = select(number < count, rest * rest, Real{});
            all_weights += w;
            wd = w * d;
        }
        sum = sum + wd;
        m.xx += wd.x * d.x, m.xy += wd.x * d.y, m.xz += wd.x * d.z;
        m.yy += wd.y * d.y, m.yz += wd.y * d.z, m.zz += wd.z * d.z;
    }
    const Real3 mean = (1 / all_weights) * sum;
    return {m.xx - sum.x * mean.x, m.xy - sum.x * mean.y, m.xz - sum.x * mean.z,
            m.yy - sum.y * mean.y, m.yz - sum.y * mean.z, m.zz - sum.z * mean.z};
}

GAUSSMAP_INLINE RealSymmetric3 adjugate(const RealSymmetric3& m, Real shift) {
    const Real xx = m.xx - shift, yy = m.yy - shift, zz = m.zz - shift;
    return {yy * zz - m.yz * m.yz, m.yz * m.xz - m.xy * zz, m.xy * m.yz - yy * m.xz,
            xx * zz - m.xz * m.xz, m.xy * m.xz - xx * m.yz, xx * yy - m.xy * m.xy};
}

/// As `smallest_eigenvector` of eigen3.h, which tells why.
GAUSSMAP_INLINE Mask smallest_eigenvector(const RealSymmetric3& m, Real3& vector) {
    const Real trace = m.xx + m.yy + m.zz;
    const Real minors = m.xx * m.yy - m.xy * m.xy + (m.xx * m.zz - m.xz * m.xz) + (m.yy * m.zz - m.yz * m.yz);
    const Real determinant =
        m.xx * (m.yy * m.zz - m.yz * m.yz) - m.xy * (m.xy * m.zz - m.yz * m.xz) + m.xz * (m.xy * m.yz - m.yy * m.xz);
    Real lambda = {};
    for (int step = 0; step < 2; ++step)
        lambda -= (((lambda - trace) * lambda + minors) * lambda - determinant) /
                  ((3 * lambda - 2 * trace) * lambda + minors);
    const RealSymmetric3 a = adjugate(m, lambda);
    const Mask x = (a.xx > a.zz) & (a.xx >= a.yy), y = (a.yy > a.zz) & (a.yy > a.xx);
    vector = select(y, {a.xy, a.yy, a.yz}, select(x, {a.xx, a.xy, a.xz}, {a.xz, a.yz, a.zz}));
    lambda = dot(vector, m * vector) / squared(vector);
    vector = unit(adjugate(m, lambda) * vector);
    const Real3 image = m * vector;
    lambda = dot(vector, image);
    const Real gap = (minors - lambda * (trace - lambda)) / (trace - lambda) - lambda;
    return (minors > 0.01 * trace * trace) & (square_root(squared(image - lambda * vector)) <= 0x1p-50 * gap);
}

void principal(const LanePatches& patches, const LaneCounts& counts, bool weighted, LaneNormals& normals) {
    for (int lane = 0; lane < fit_lanes; lane += lanes) {
        Real3 vector;
        const Mask found = smallest_eigenvector(
            weighted ? moments<true>(patches, counts, lane) : moments<false>(patches, counts, lane), vector);
        const Mask down = (vector.z < 0) | ((vector.z == 0) & ((vector.y < 0) | ((vector.y == 0) & (vector.x < 0))));
        store3(normals.n, lane, select(down, -vector, vector));
        for (int l = 0; l < lanes; ++l) normals.found[lane + l] = found[l] != 0;
    }
}

}  // namespace
}  // namespace gaussmap
