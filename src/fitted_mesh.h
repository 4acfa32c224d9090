// The estimators that fit something to a mesh's vertices, whose neighbours are told by the edges.
#pragma once

#include "gaussmap/curvature.h"

namespace gaussmap {

/// `Estimator::automatic`, `jet` and `regression`: make `density`, `lowered`, for `automatic` `choice`, and as asked
/// for `error` and `vertex_tensor`. The result's `normals`, which must be there (unit or NaN), tell the sides and
/// become those of the fits, where there is a fit; regression is on them where they are `given`, else on fitted ones.
/// \param options  checked.
/// \throw std::invalid_argument at an index outside the vertices.
void fitted_mesh(Points vertices, Triangles faces, bool given, const MeshCurvatureOptions& options,
                 MeshCurvature& result);

}  // namespace gaussmap
