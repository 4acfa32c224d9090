// The estimators that fit surfaces to a cloud's points.
#pragma once

#include "gaussmap/curvature.h"

namespace gaussmap {

/// `Estimator::automatic`. Given normals tell the signs of the shape operators, and nothing else.
/// \param normals  checked.
CloudCurvature automatic_cloud(Points points, Points normals, const CloudCurvatureOptions& options);

}  // namespace gaussmap
