// Sums for the algebraic spheres of four places, a lane each, over samples of a surface. Every lane does the same
// operations in the same order whatever the others hold, so every instruction set gives the same bits.
#pragma once

#include <limits>

#include "algebraic_sphere.h"
#include "lane_averages.h"

namespace gaussmap {

/// A place on a surface, in one place, as samples are taken from all over; NaN where nothing is.
struct alignas(64) SphereSample {
    double normal[3] = {nan, nan, nan}, foot[3] = {nan, nan, nan};
    double weight = 0;

    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
};

/// Four places, and how far about them samples are taken in.
struct alignas(32) LaneBalls : LaneFrames {
    LaneValues radius = {};
};

/// Places and normals in the frame, the former in units of the radius.
struct alignas(32) LaneSpheres {
    LaneValues sum[SphereSums::terms][SphereSums::parts];

    SphereSums sums(int lane) const {
        SphereSums of;
        for (int t = 0; t < SphereSums::terms; ++t)
            for (int i = 0; i < SphereSums::parts; ++i) of.sum[t][i] = sum[t][i][lane];
        return of;
    }
};

/// Where the chord of a sample is this steep, its sine squared, it is across a tube or a hole, though it may look along
/// the same line; but not where its square is below that of a tenth of the radius.
constexpr double overhead = 0.8, near_by = 0.01;

/// Samples that look elsewhere, are overhead, or are not within the radius, do not count.
typedef void LaneSphereKernel(const SphereSample* samples, const LaneBalls& balls, LaneSpheres& spheres);
extern LaneSphereKernel lane_spheres_baseline;
extern LaneSphereKernel lane_spheres_avx2;

}  // namespace gaussmap
