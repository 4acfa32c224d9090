// Energies of fans, eq. (3) of docs/method.md, for one instruction set. Part of cloud_kernel_<set>.cpp alone; nothing
// here may have external linkage.
#pragma once

#include "cloud_kernel.h"
#include "degenerate.h"
#include "real3.h"

namespace gaussmap {
namespace {

/// kappa = ½ Σ cot(α) |dn|² over the edges of each triangle (0, a, b) with unit normals at its corners, cot(α) =
/// (product of the edges that meet in α) / (2 area).
GAUSSMAP_INLINE void energies_of(const LaneStrips& strips, bool align, int lane, LaneEnergies& energies) {
    const Real3 normal = load3(strips.normal, lane);
    const auto normal_at = [&](int c) {
        const Real3 n = load3(strips.n[c], lane);
        return align ? select(dot(n, normal) < 0, -n, n) : n;
    };
    const int last = most(strips.count, lane);
    const Real count = counted(strips.count, lane);
    Real kappa = load(&energies.kappa[lane]), area = load(&energies.area[lane]), number = all(1);
    Real3 a = load3(strips.d[0], lane), normal_a = normal_at(0);
    for (int c = 1; c < last; ++c, number += 1) {
        const Real3 b = load3(strips.d[c], lane), normal_b = normal_at(c);
        const Real at_point = dot(a, b), at_a = dot(a, a - b), at_b = dot(b, b - a);
        const Real sum = at_point * squared(normal_b - normal_a) + at_a * squared(normal_b - normal) +
                         at_b * squared(normal_a - normal);
        const Real cross_squared = squared(cross(a, b)), half_squares = at_point + at_a + at_b;
        const Mask counts = (number < count) & (absolute(sum) <= __DBL_MAX__) &
                            ~(cross_squared <= no_area_ratio * (half_squares * half_squares));
        const Real twice_area = square_root(cross_squared);
        // Never negative; rounding could make it so by its last bit.
        kappa += select(counts, select(sum > 0, sum, Real{}) / (2 * twice_area), Real{});
        area += select(counts, 0.5 * twice_area, Real{});
        a = b, normal_a = normal_b;
    }
    store(&energies.kappa[lane], kappa);
    store(&energies.area[lane], area);
}

void energies(const LaneStrips& strips, bool align, LaneEnergies& found) {
    for (int lane = 0; lane < fit_lanes; lane += lanes) energies_of(strips, align, lane, found);
}

}  // namespace
}  // namespace gaussmap
