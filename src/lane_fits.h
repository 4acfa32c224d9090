// Least-squares fits of height fields to the neighbours of four elements side by side, a lane each. Every lane does the
// same operations in the same order whatever the others hold, so every instruction set gives the same bits.
#pragma once

#include "height_fit.h"
#include "patch.h"

namespace gaussmap {

constexpr int fit_lanes = 4;
constexpr int most_fitted = 36;  ///< neighbours

typedef double LaneValues[fit_lanes];

/// The neighbours of four elements, and the frames that they are seen in.
struct alignas(32) LanePatches {
    LaneValues d[most_fitted][3] = {};  ///< differences from the element
    LaneValues axis[3][3] = {};         ///< u, v and n of the frame over the unit of lengths

    void see(int lane, const Frame& frame, double size) {
        const Vec3 axes[3] = {frame.u, frame.v, frame.n};
        const double scale = 1 / size;
        for (int a = 0; a < 3; ++a) {
            axis[a][0][lane] = scale * axes[a].x;
            axis[a][1][lane] = scale * axes[a].y;
            axis[a][2][lane] = scale * axes[a].z;
        }
    }
};

/// Which neighbours to take in, [first, last) of each lane, and how.
struct LaneRange {
    int first[fit_lanes], last[fit_lanes];
    Chart chart;
    bool weighted;  ///< by 1 / |d|¹⁰ (docs/method.md, eq. (17)), else equally
};

/// Weighted sums of uⁱ vʲ up to twice the degree, of those up to the degree times the height, and of the squared
/// height. A product of monomials is a monomial, and so has its sum made once.
struct alignas(32) LaneSums {
    static constexpr int power = 0, height = monomials(8), square = height + monomials(4);
    LaneValues at[square + 1];
};

/// What is wanted of a fit.
struct alignas(32) LaneFields {
    LaneValues c[monomials(2)];   ///< coefficients of 1, u, v, u², uv, v²
    LaneValues residual;          ///< weighted sum of the squared residuals
    LaneValues covariance[3][3];  ///< as of `HeightField`; left alone unless asked for
    bool determined[fit_lanes];   ///< by the places of the data; whether there are enough is not looked at
};

/// Fits of one degree, compiled for one instruction set.
struct LaneFit {
    /// Add a range of neighbours to the sums, which start from 0 where `fresh`.
    void (*collect)(const LanePatches& patches, const LaneRange& range, bool fresh, LaneSums& sums);
    /// Height fields through the elements, or, with `constant`, past them: then they are data, of weight 1.
    void (*solve)(const LaneSums& sums, bool constant, bool covariance, LaneFields& fields);
};

struct LaneFitKernel {
    LaneFit quadric, quartic;
};
extern const LaneFitKernel lane_fit_baseline;
extern const LaneFitKernel lane_fit_avx2;

/// What the machine runs fastest.
const LaneFitKernel& best_lane_fit();

}  // namespace gaussmap
