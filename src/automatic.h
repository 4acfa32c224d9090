// The estimator that chooses for itself, on elements whose neighbours are told by a function: points of a cloud by
// their nearest others, vertices of a mesh by their rings (docs/method.md, "Choosing from the data").
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "element_graph.h"
#include "fitted_curvature.h"

namespace gaussmap {

/// What was measured, and how far noise and averages reach.
struct AutomaticCurvature : FittedCurvature {
    std::vector<std::uint8_t> on_grid;  ///< whether remainders are alike from one element to the next
    ElementGraph graph;                 ///< of the elements, for averages over the surface
    double unit = 1;                    ///< about an edge's squared length, a power of 4
};

/// \param size  the diagonal of the elements' box, positive and finite.
/// The same bits for any number of threads. Time O(n) fits of at least 24 neighbours; more only where there is noise.
AutomaticCurvature automatic_curvature(const Elements& elements, double size, const Execution& run);

/// The choice of elements whose quartics stand, by the first look; those with too few neighbours for one have 1.
constexpr std::uint8_t look_choice = 2;

/// The first look alone, at elements that follow each other, by themselves; 0 is the choice of those that noise would
/// send on to the ladder.
AutomaticCurvature first_looks(const Elements& elements, std::size_t first, std::size_t count, double size,
                               const Execution& run);

/// Takes what was measured at an element: entry i of `found`.
using TakeMeasured = std::function<void(const AutomaticCurvature& found, std::size_t i, std::size_t element)>;

/// The same, handed out element by element, not always in order; the number of `lowered` ones. Many elements are looked
/// at in tiles, of those that follow each other, and forgotten, as long as there is no noise; averages over the surface
/// nearby end where tiles do, so elements that follow each other should be near each other. Memory 25 MB; where there
/// is noise as much as for all at once.
std::size_t automatic_curvature(const Elements& elements, double size, const TakeMeasured& take, const Execution& run);

}  // namespace gaussmap
