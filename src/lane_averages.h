// Averages of what quadrics found over the surface about four elements, a lane each: of their shape operators, and of
// the slopes of their normals over their feet. Every lane does the same operations in the same order whatever the
// others hold, so every instruction set gives the same bits.
#pragma once

#include <cstdint>
#include <limits>

#include "frame.h"
#include "lane_fits.h"
#include "slope_fit.h"

namespace gaussmap {

/// Normals of which the cosine is less look too far apart to be of one sheet.
constexpr double one_sheet = 0.3;

/// What is known of the surface at an element's foot, in one place, as samples are taken from all over; NaN where
/// nothing is.
struct alignas(32) SurfaceSample {
    double normal[3] = {nan, nan, nan}, foot[3] = {nan, nan, nan};
    double tensor[6] = {nan, nan, nan, nan, nan, nan};  ///< xx xy xz yy yz zz, of the tangent plane
    double weight = 0;                                  ///< area that it stands for, relative to others

    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
};

/// Where four elements are seen from, and the samples about them.
struct alignas(32) LaneFrames {
    LaneValues axis[3][3] = {};  ///< of the frame about the normal: u, v, n
    LaneValues foot[3] = {};
    const std::int32_t* samples[fit_lanes] = {};  ///< −1 where there is none, or where it is not to count
    int count = 0;                                ///< of the samples of each lane
    int stride = 1;                               ///< of a row one in so many is a sample

    void set(int lane, const Frame& frame, Vec3 at) {
        const Vec3 axes[3] = {frame.u, frame.v, frame.n};
        for (int a = 0; a < 3; ++a)
            axis[a][0][lane] = axes[a].x, axis[a][1][lane] = axes[a].y, axis[a][2][lane] = axes[a].z;
        foot[0][lane] = at.x, foot[1][lane] = at.y, foot[2][lane] = at.z;
    }
};

/// Four elements that averages are taken about.
struct alignas(32) LaneCentres : LaneFrames {
    LaneValues unit = {};      ///< what places in the tangent plane are multiplied by
    LaneValues reach[2] = {};  ///< of the windows, squared; the first is the narrower
};

/// Sums over the samples in a window, with their weights times 1 − (d/h)².
struct alignas(32) LaneAverages {
    LaneValues weight, count;
    LaneValues tensor[3];  ///< uu, uv, vv, each turned into the element's tangent plane by the smallest rotation
    LaneValues power[SlopeFit::powers], slope[SlopeFit::most][2], normal[2], square;

    /// \param own  weight of the element itself.
    SlopeFit slopes(int lane, double own) const {
        SlopeFit fit;
        double powers[SlopeFit::powers], slopes[SlopeFit::most][2];
        for (int p = 0; p < SlopeFit::powers; ++p) powers[p] = power[p][lane];
        for (int m = 0; m < SlopeFit::most; ++m)
            for (int c = 0; c < 2; ++c) slopes[m][c] = slope[m][c][lane];
        fit.set(powers, slopes, square[lane], static_cast<int>(count[lane]));
        fit.let_free(own, weight[lane], {normal[0][lane], normal[1][lane]});
        return fit;
    }
};

/// Of both windows. Samples that look elsewhere, or are not within the wider window, do not count.
typedef void LaneAverageKernel(const SurfaceSample* samples, const LaneCentres& centres, LaneAverages (&windows)[2]);
extern LaneAverageKernel lane_averages_baseline;
extern LaneAverageKernel lane_averages_avx2;

}  // namespace gaussmap
