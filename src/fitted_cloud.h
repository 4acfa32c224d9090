// The estimators that fit surfaces to a cloud's points.
#pragma once

#include "gaussmap/curvature.h"

namespace gaussmap {

/// `Estimator::automatic`, `regression` and `jet`. Regression is on the given normals; to the others they tell the side
/// of the fitted normals, and nothing else.
/// \param normals  checked, as the options are.
CloudCurvature fitted_cloud(Points points, Points normals, const CloudCurvatureOptions& options);

}  // namespace gaussmap
