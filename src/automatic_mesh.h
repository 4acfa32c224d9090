// `Estimator::automatic` on the vertices of a mesh, whose neighbours are told by the edges.
#pragma once

#include "gaussmap/curvature.h"

namespace gaussmap {

/// Make `density`, `choice`, and as asked for `error` and `vertex_tensor`. The result's `normals`, which must be there
/// (unit or NaN), tell the sides and become those of the fits, where there is a fit.
/// \throw std::invalid_argument at an index outside the vertices.
void automatic_mesh(Points vertices, Triangles faces, const MeshCurvatureOptions& options, MeshCurvature& result);

}  // namespace gaussmap
