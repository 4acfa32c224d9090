// What noise is left in densities from one element to the next.
#pragma once

#include <vector>

#include "gaussmap/types.h"
#include "pyramid.h"

namespace gaussmap {

/// Smooth the densities of elements that were measured on a rung, their tensors with them, and take what noise goes off
/// the errors. What densities vary by over more than a few neighbours stays.
/// \param noise  variance of the elements' places along an axis, by noise; NaN where it is not known.
void smooth_densities(const Level& lowest, const std::vector<float>& noise, Measured& measured, const Execution& run);

}  // namespace gaussmap
