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

/// Normals have no side. A sample's is the one that a circle through the place and the sample would have: less than
/// this much along it, the cosine, it is of something else. Not so within a tenth of the radius, whose square this is,
/// as noise tilts short chords.
constexpr double as_expected = 0.5, near_by = 0.01;
/// Least cosine of the angle between a sample's normal, so turned, and the place's: the far half of a tube bends
/// another way.
constexpr double same_half = 0.1;

/// Four places, and how far about them samples are taken in.
struct alignas(32) LaneBalls : LaneFrames {
    LaneValues radius = {};
    double least_expected = as_expected, least_cosine = same_half;
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

/// Samples whose normals are not so, or that are not within the radius, do not count.
typedef void LaneSphereKernel(const SphereSample* samples, const LaneBalls& balls, LaneSpheres& spheres);
extern LaneSphereKernel lane_spheres_baseline;
extern LaneSphereKernel lane_spheres_avx2;

}  // namespace gaussmap
