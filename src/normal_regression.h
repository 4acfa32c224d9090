// The shape operator of each element by least squares of its neighbours' normals (docs/method.md, "Normal regression").
#pragma once

#include <cstdint>
#include <vector>

#include "fitted_curvature.h"
#include "gaussmap/normals.h"

namespace gaussmap {

/// Normals to regress on, one an element.
struct ElementNormals {
    std::vector<Vec3> normal;           ///< unit; NaN where undefined
    bool align = false;                 ///< their sides mean nothing: turn neighbours' to the element's
    std::vector<std::uint8_t> lowered;  ///< where a jet took a lower degree than asked for; empty for none
};

/// Normals fitted to the k nearest neighbours of each element.
ElementNormals fit_normals(const Elements& elements, int k, CloudNormals method, int degree, const Execution& run);

/// Over the k nearest neighbours that have a normal. Quadratic; where they do not determine that with one left over,
/// linear and counted. Undefined where there is no normal or not even two directions.
/// \param error  make `error`, from the residuals: NaN where no neighbour is left over.
/// Time O(n k).
FittedCurvature normal_regression(const Elements& elements, int k, const ElementNormals& normals, bool error,
                                  const Execution& run);

}  // namespace gaussmap
