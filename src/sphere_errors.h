// The squared errors that are told of densities of level sets of spheres.
#pragma once

#include <vector>

#include "gaussmap/types.h"
#include "pyramid.h"

namespace gaussmap {

/// Tell them anew where a family of spheres is the best that was mixed, by what it had told before, noise included.
/// \param noise  variance of the heights, an element of the lowest level each; NaN where unknown.
void tell_sphere_errors(const Level& lowest, const std::vector<float>& noise, Measured& measured, const Execution& run);

}  // namespace gaussmap
