// Edges collapsed in passes over the mesh, the cheapest of those that do not meet in each.
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
    carried,    ///< the same, their planes carried along to where their vertex goes
    present,  ///< quadrics of the surface as it is. Lindstrom and Turk, "Evaluation of Memoryless Simplification", 1999
};

struct CollapseOptions {
    CollapseCost cost = CollapseCost::present;
    std::size_t faces = 0;  ///< stop here
    double share = 0.1;  ///< of the vertices, offered in a pass near the target: less is nearer to greedy, and slower
    double border_weight = 1;  ///< of the planes that stand on tagged sides, beside that of faces
    bool allow_topology = false;
    Execution run;
};

/// Collapse edges until there are at most `options.faces` faces, or no valid collapse is left. The mesh is left without
/// gaps.
/// \param weight  of each vertex.
/// \return the vertex that each vertex joined, as they are numbered now; −1 for those of no face.
/// Time O(n) where degrees are bounded and the target is a fixed part; costs are found side by side.
std::vector<std::int32_t> collapse_in_passes(RingMesh& mesh, std::vector<float> weight, const CollapseOptions& options);

}  // namespace gaussmap
