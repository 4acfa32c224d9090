// Curvature of a polynomial height field through each element (docs/method.md, "Jets").
#pragma once

#include "fitted_curvature.h"

namespace gaussmap {

/// Over the k nearest neighbours. Where they do not determine the degree, the highest that they do determine is taken
/// and counted; undefined where that is below 2.
/// \param degree  2 to 4.
/// \param error   make `error`: NaN where no neighbour is left over.
/// Time O(n k degree⁴). Source: Cazals and Pouget, "Estimating differential quantities using polynomial fitting of
/// osculating jets", CAGD 22(2), 2005.
FittedCurvature jet_curvature(const Elements& elements, int k, int degree, bool error, const Execution& run);

}  // namespace gaussmap
