// What clouds go through point by point, done for four points side by side, a lane each: principal directions, fans and
// their energies. Every lane does the same operations in the same order whatever the others hold, so every instruction
// set gives the same bits. What is rare is left to be done alone: principal_normal.h, fan.h.
#pragma once

#include <cstdint>

#include "lane_fits.h"

namespace gaussmap {

/// Neighbours there are in each lane; the differences beyond are 0 up to the largest count and one more.
typedef std::int32_t LaneCounts[fit_lanes];

struct alignas(32) LaneNormals {
    LaneValues n[3];        ///< unit, looking up
    bool found[fit_lanes];  ///< false where the quick way does not tell the direction to rounding error
};

/// Closed fans as of fan.h, from the nearest corner on.
struct LaneFans {
    static constexpr int most_corners = 16;
    std::int32_t chain[most_corners + 1][fit_lanes];  ///< neighbours, the first once more at the end
    LaneCounts corners;                               ///< 0 where the fan is open, large, or hangs on rounding
};

/// Triangles between the points and each two consecutive others.
struct alignas(32) LaneStrips {
    static constexpr int most_others = LaneFans::most_corners + 1;
    LaneValues d[most_others][3];  ///< differences from the point
    LaneValues n[most_others][3];  ///< unit normals
    LaneValues normal[3];          ///< of the point
    LaneCounts count;              ///< of the others
};

struct alignas(32) LaneEnergies {
    LaneValues kappa, area;
};

struct CloudKernel {
    /// As `principal_normal`.
    void (*principal)(const LanePatches& patches, const LaneCounts& counts, bool weighted, LaneNormals& normals);
    /// Of the neighbours projected along the normals.
    void (*fans)(const LanePatches& patches, const LaneCounts& counts, const LaneValues (&normal)[3], LaneFans& fans);
    /// Added to what is there. With `align`, normals that look away from the point's are turned round.
    void (*energies)(const LaneStrips& strips, bool align, LaneEnergies& energies);
};
extern const CloudKernel cloud_kernel_baseline;
extern const CloudKernel cloud_kernel_avx2;

/// What the machine runs fastest.
const CloudKernel& best_cloud_kernel();

}  // namespace gaussmap
