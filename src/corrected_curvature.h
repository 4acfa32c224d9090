// Interpolated corrected curvature measures.
#pragma once

#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// Density of every vertex, 4H² − 2K = (Σμ1/Σμ0)² − 2 Σμ2/Σμ0 over its faces, clamped at 0; NaN where undefined.
/// \param unit_normals  one a vertex, NaN where undefined (faces that touch such a vertex add nothing).
/// \throw std::invalid_argument at an index outside the vertices.
std::vector<double> corrected_density(Points vertices, Triangles faces, Points unit_normals, const Execution& run);

}  // namespace gaussmap
