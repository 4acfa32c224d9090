// Normals by principal directions (Hoppe et al. 1992).
#pragma once

#include <span>

#include "neighborhood.h"
#include "vec.h"

namespace gaussmap {

/// The smallest principal direction of the point and its neighbours, looking up; NaN where they span no plane.
/// Every one weighs the same, or `weighted` (1 − (d/h)²)² by its distance d from the point: smooth, and 0 where the
/// next neighbour of a surface would come, h² = d_k² (k + 1)/k.
Vec3 principal_normal(const Neighborhood& neighborhood, bool weighted);

/// The same of the first `count` neighbours, given as differences from the point, every one of the same weight.
Vec3 principal_normal(std::span<const Vec3> neighbors, int count);

}  // namespace gaussmap
