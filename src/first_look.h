// The first look at elements, four at a time: interpolating quartics over their nearest neighbours, and what the
// residuals tell.
#pragma once

#include <algorithm>
#include <limits>

#include "lane_fits.h"
#include "principal_normal.h"
#include "shape_tensor.h"
#include "vec.h"

namespace gaussmap {

constexpr int look_neighbors = 24;  ///< that quartics are fitted to
constexpr int wide_neighbors = 36;  ///< that the noise is told apart with
static_assert(wide_neighbors <= most_fitted);

/// In units of the elements' lengths. NaN where it is not determined.
struct FirstLook {
    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

    Vec3 normal = {nan, nan, nan};
    /// Fits through the element, and for each a measure of its error.
    struct Fit {
        Symmetric3 tensor;
        double density = nan;
        double change = nan;   ///< of the density, by another fit that is somewhat worse
        double widened = nan;  ///< and by the same fit over more neighbours
    };
    /// Quartics, weighted by the inverse of the expected remainder, in chords and in Monge coordinates; equal weights
    /// change them. A quadric in chords over few neighbours; the quartic changes it.
    Fit chord, monge, quadric;
    /// Of the density and of the shape operator with equal weights, for heights of unit variance.
    double variance = nan, trace = nan;
    /// Residual variance of quartics over `look_neighbors` and `wide_neighbors`.
    double residual = nan, wide_residual = nan;
    bool lowered = false;  ///< too few neighbours for a quartic
};

/// Variance of the heights' noise, from the residual variances of quartics over k and over 3/2 k neighbours. Noise
/// leaves the two alike; a remainder of degree 5 grows with h¹⁰, 7.6-fold between full windows, and by more than 4
/// between those at hand.
inline double noise_variance(double residual, double wider) {
    constexpr double growth = 4;
    return std::max(0.0, (growth * residual - wider) / (growth - 1));
}

/// Look at the elements of four lanes.
/// \param patches  differences of the neighbours, nearest first, finite everywhere.
/// \param counts   neighbours that there are, up to `wide_neighbors`; 0 in lanes without an element.
void first_look(LanePatches& patches, const int (&counts)[fit_lanes], FirstLook (&looks)[fit_lanes],
                const LaneFitKernel& kernel = best_lane_fit());

}  // namespace gaussmap
