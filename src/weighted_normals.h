// Vertex normals by chunks of faces that others have made, and use again.
#pragma once

#include <vector>

#include "first_touch.h"
#include "gaussmap/normals.h"

namespace gaussmap {

/// `mesh_normals` by the chunks of the faces.
std::vector<double> weighted_normals(Points vertices, Triangles faces, const FaceChunks& chunks, NormalWeights weights,
                                     const Execution& run);

}  // namespace gaussmap
