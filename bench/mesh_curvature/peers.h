// What the fused pass is measured against.
#pragma once

#include <vector>

#include "gaussmap/types.h"

/// Density of every vertex the textbook way: for each triangle the sparse 3 × 3 cotangent matrix S from triplets and
/// trace(N S Nᵀ), with Eigen.
std::vector<double> textbook_density(gaussmap::Points vertices, gaussmap::Triangles faces, gaussmap::Points normals);

/// a = b + s c over arrays of `count` doubles: 24 bytes of memory traffic an item (STREAM's triad).
void triad(std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c, double s);
