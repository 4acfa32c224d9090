// From which points of the input the vertices of a decimated mesh take their values.
#pragma once

#include <vector>

#include "decimation_input.h"
#include "face_boxes.h"
#include "gaussmap/decimate.h"
#include "ring_mesh.h"

namespace gaussmap {

/// Near points of the input, found without a search: the nearest on the faces around that one of the vertices joined in
/// a coarse vertex which is nearest to it. \param joined  the coarse vertex of each vertex of the input, −1 of none.
std::vector<SurfacePoint> joined_sources(const DecimationInput& in, const RingMesh& coarse,
                                         const std::vector<std::int32_t>& joined);

/// The nearest point of the input to every vertex of the coarse mesh.
std::vector<SurfacePoint> vertex_sources(const DecimationInput& in, const FaceBoxes& fine, const RingMesh& coarse,
                                         const Execution& run);

/// For every corner of the coarse mesh the nearest point of the input on those faces that can be reached from the
/// origin of its face without crossing a seam. \param fine  the input, its seams tagged and nothing else.
std::vector<SurfacePoint> corner_sources(const DecimationInput& in, const RingMesh& fine, const RingMesh& coarse,
                                         const Execution& run);

}  // namespace gaussmap
