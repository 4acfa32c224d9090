// The estimator that chooses for itself, on elements whose neighbours are told by a function: points of a cloud by
// their nearest others, vertices of a mesh by their rings (docs/method.md, "Choosing from the data").
#pragma once

#include "element_graph.h"
#include "fitted_curvature.h"

namespace gaussmap {

/// What was measured, and how far noise and averages reach.
struct AutomaticCurvature : FittedCurvature {
    ElementGraph graph;  ///< of the elements, for averages over the surface
    double unit = 1;     ///< about an edge's squared length, a power of 4
};

/// \param size  the diagonal of the elements' box, positive and finite.
/// The same bits for any number of threads. Time O(n) fits of at least 24 neighbours; more only where there is noise.
AutomaticCurvature automatic_curvature(const Elements& elements, double size, const Execution& run);

}  // namespace gaussmap
