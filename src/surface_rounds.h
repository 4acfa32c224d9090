// A coarse mesh brought as near to a fine one as its number of faces allows.
#pragma once

#include "decimation_input.h"
#include "face_boxes.h"
#include "gaussmap/decimate.h"
#include "ring_mesh.h"

namespace gaussmap {

/// Move and flip a fixed number of rounds, then lower peaks.
/// \param joined  the vertex of the coarse mesh that each vertex of the input joined.
/// \param fine    the boxes of the input's faces.
void bring_nearer(RingMesh& coarse, const DecimationInput& in, const FaceBoxes& fine,
                  const std::vector<std::int32_t>& joined, DecimationObjective objective, const Execution& run);

}  // namespace gaussmap
