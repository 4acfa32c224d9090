// What the fused pass is measured against.
#pragma once

#include <memory>
#include <vector>

#include "gaussmap/types.h"

/// A mesh as Eigen's matrices, a vertex or face a row.
struct Textbook;
std::shared_ptr<const Textbook> textbook_mesh(gaussmap::Points vertices, gaussmap::Triangles faces,
                                              gaussmap::Points normals);

/// Density of every vertex the textbook way: for each triangle the sparse 3 × 3 cotangent matrix S from triplets and
/// the quadratic forms of the normals' coordinates, with Eigen.
std::vector<double> textbook_density(const Textbook& mesh);

/// a = b + s c over arrays of `count` doubles: 24 bytes of memory traffic an item (STREAM's triad).
void triad(std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& c, double s);
