// Errors told by first looks, held against what looks at half of the elements err.
#pragma once

#include <cstddef>
#include <functional>

#include "fitted_curvature.h"

namespace gaussmap {

/// What the errors that first looks tell should be multiplied by, from 0.65 to 1.25: every other element is looked at
/// with the others left out, and how far that is off, by the density of the whole, is compared with the error that it
/// tells. 1 where this says nothing: too few elements, noise, or a shape that half of them cannot tell.
/// \param elements  those that follow each other near each other.
/// \param size      the diagonal of the elements' box, positive and finite.
/// \param density   an element's, by its first look; NaN where something else was taken, and on a grid, half of which
///                  is none.
/// Time of looks at up to 16,384 elements, and of their neighbours; the same for any number of threads.
double told_error_factor(const Elements& elements, double size, const std::function<double(std::size_t)>& density,
                         const Execution& run);

}  // namespace gaussmap
