// The cheapest edge collapses, one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"
#include "ring_mesh.h"

namespace gaussmap {

enum class CollapseCost {
    length,     ///< of the edge, to its midpoint
    inherited,  ///< quadrics of the first surface, added up as vertices join
    present,  ///< quadrics of the surface as it is. Lindstrom and Turk, "Evaluation of Memoryless Simplification", 1999
};

struct GreedyOptions {
    CollapseCost cost = CollapseCost::inherited;
    std::size_t faces = 0;     ///< stop here
    double border_weight = 1;  ///< of the planes that stand on tagged sides, beside that of faces
    bool allow_topology = false;
    Execution run;
};

/// Collapse edges until there are at most `options.faces` faces, or no valid collapse is left.
/// \param weight  of each vertex.
/// \return the vertex that each vertex joined, itself for those that stay (and those of no face).
/// Time O(c log n) for c collapses where degrees are bounded. Nothing is allocated in the loop.
std::vector<std::int32_t> collapse_cheapest(RingMesh& mesh, std::vector<double> weight, const GreedyOptions& options);

}  // namespace gaussmap
