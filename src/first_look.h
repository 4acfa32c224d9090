// The first look at an element: interpolating quartics over its nearest neighbours, and what the residuals tell.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "shape_tensor.h"
#include "vec.h"

namespace gaussmap {

constexpr int look_neighbors = 24;  ///< that quartics are fitted to
constexpr int wide_neighbors = 36;  ///< that the noise is told apart with

/// In units of the elements' lengths. NaN where it is not determined.
struct FirstLook {
    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

    Vec3 normal = {nan, nan, nan};
    /// Fits through the element, and for each a measure of its error.
    struct Fit {
        Symmetric3 tensor;
        double density = nan;
        double change = nan;  ///< of the density, by another fit that is somewhat worse
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

/// Smallest principal direction of the element and its neighbours; NaN where they lie on a line.
Vec3 principal_normal(const std::vector<Vec3>& neighbors, int count);

/// \param neighbors  differences from the element, nearest first.
FirstLook first_look(const std::vector<Vec3>& neighbors, int count);

}  // namespace gaussmap
