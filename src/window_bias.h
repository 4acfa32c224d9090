// What windows have smoothed away of the densities on the ladder.
#pragma once

#include "element_graph.h"
#include "gaussmap/types.h"
#include "pyramid.h"

namespace gaussmap {

/// Add it, squared, to the errors of elements that were measured on a rung, but by spheres (sphere_errors.h). For what
/// is told of the error alone: the choice of the rung has its own, sharper means where these see something.
void add_window_bias(const ElementGraph& graph, Measured& measured, const Execution& run);

}  // namespace gaussmap
