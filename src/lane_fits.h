// Least-squares fits of height fields to the neighbours of four elements side by side, a lane each. Every lane does the
// same operations in the same order whatever the others hold, so every instruction set gives the same bits.
#pragma once

#include <cstddef>

#include "height_fit.h"
#include "patch.h"

namespace gaussmap {

constexpr int fit_lanes = 4;

typedef double LaneValues[fit_lanes];
typedef LaneValues LaneNeighbor[3];  ///< differences x, y, z from the element

/// Where the neighbours of four elements are seen from.
struct alignas(32) LaneViews {
    LaneValues axis[3][3] = {};  ///< u, v and n of the frame over the unit of lengths
    LaneValues foot[3] = {};     ///< the origin

    void see(int lane, const Frame& frame, double size, Vec3 from = {}) {
        const Vec3 axes[3] = {frame.u, frame.v, frame.n};
        const double scale = 1 / size;
        for (int a = 0; a < 3; ++a) {
            axis[a][0][lane] = scale * axes[a].x;
            axis[a][1][lane] = scale * axes[a].y;
            axis[a][2][lane] = scale * axes[a].z;
        }
        foot[0][lane] = from.x, foot[1][lane] = from.y, foot[2][lane] = from.z;
    }
};

constexpr int most_fitted = 36;  ///< neighbours in a patch

/// The nearest neighbours of four elements, and how they are seen.
struct LanePatches : LaneViews {
    LaneNeighbor d[most_fitted] = {};
};

/// What a neighbour weighs, by its distance |d| in units of the view.
enum class Weights {
    equal,
    remainder,  ///< 1 / |d|¹⁰ (docs/method.md, eq. (17))
    smoothing,  ///< 1 − |d|², and a little more, so that the farthest neighbour counts too: the least error for noisy
                ///< data (Fan, Gasser, Gijbels, Brockmann and Engel, 1997)
};

/// Which neighbours to take in, [first, last) of each lane, and how.
struct LaneRange {
    int first[fit_lanes], last[fit_lanes];
    Chart chart;
    Weights weights;
};

/// What a height field is at the element itself.
enum class AtElement {
    zero,   ///< it passes through it
    datum,  ///< the element is one more datum, of weight 1
    free,   ///< it is not looked at
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

    /// The fit in a lane; `free` is left out.
    HeightField<2> field(int lane) const {
        HeightField<2> field;
        for (int m = 0; m < monomials(2); ++m) field.c[static_cast<std::size_t>(m)] = c[m][lane];
        for (int p = 0; p < 3; ++p)
            for (int q = 0; q < 3; ++q) field.covariance[p][q] = covariance[p][q][lane];
        field.residual = residual[lane];
        return field;
    }
};

/// Fits of one degree, compiled for one instruction set.
struct LaneFit {
    /// Add a range of neighbours to the sums, which start from 0 where `fresh`.
    void (*collect)(const LaneNeighbor* neighbors, const LaneViews& views, const LaneRange& range, bool fresh,
                    LaneSums& sums);
    /// The height fields of the degree, from sums of this or a higher one.
    void (*solve)(const LaneSums& sums, AtElement element, bool covariance, LaneFields& fields);
};

struct LaneFitKernel {
    LaneFit quadric, quartic;
};
extern const LaneFitKernel lane_fit_baseline;
extern const LaneFitKernel lane_fit_avx2;

/// What the machine runs fastest.
const LaneFitKernel& best_lane_fit();

}  // namespace gaussmap
