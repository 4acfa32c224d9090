// What noise is left in densities from one element to the next.
#pragma once

#include "gaussmap/types.h"
#include "pyramid.h"

namespace gaussmap {

/// Smooth the densities of elements that were measured on a rung, their tensors with them. What they vary by over more
/// than a few neighbours stays.
void smooth_densities(const Level& lowest, Measured& measured, const Execution& run);

}  // namespace gaussmap
