// From which points of the input the vertices of a decimated mesh take their values.
#pragma once

#include <vector>

#include "decimation_input.h"
#include "gaussmap/decimate.h"
#include "ring_mesh.h"

namespace gaussmap {

/// The nearest point of the input to every vertex of the coarse mesh.
std::vector<SurfacePoint> vertex_sources(const DecimationInput& in, const RingMesh& coarse, const Execution& run);

/// For every corner of the coarse mesh the nearest point of the input on those faces that can be reached from the
/// origin of its face without crossing a seam. \param fine  the input, its seams tagged and nothing else.
std::vector<SurfacePoint> corner_sources(const DecimationInput& in, const RingMesh& fine, const RingMesh& coarse,
                                         const Execution& run);

}  // namespace gaussmap
