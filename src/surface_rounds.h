// A coarse mesh brought as near to a fine one as its number of faces allows.
#pragma once

#include "decimation_input.h"
#include "gaussmap/decimate.h"
#include "ring_mesh.h"

namespace gaussmap {

/// Fit, flip, swap and lower peaks, a fixed number of rounds.
/// \param joined  the vertex of the coarse mesh that each vertex of the input joined.
void bring_nearer(RingMesh& coarse, const DecimationInput& in, const std::vector<std::int32_t>& joined,
                  DecimationObjective objective, const Execution& run);

}  // namespace gaussmap
