// The parts of a program built like the author's (total_curvature_point_cloud.cpp of 2023, on libigl), written anew
// from how it works: the same algorithms on the same kinds of arrays, nothing made faster and nothing slower.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace author {

/// Cells of one point or none are leaves; the eight children of another cell follow one another. All arrays hold one
/// row a cell, the root first.
struct Octree {
    std::vector<std::vector<int>> points;  ///< those in the cell, of inner cells too
    Eigen::MatrixXi children;              ///< −1 in leaves
    Eigen::MatrixXd centers;
    Eigen::VectorXd widths;
};

/// Points all of which are different; copies would be parted without end.
Octree octree(const Eigen::MatrixXd& points);

/// The k points nearest to each of the first `queries` points, itself the first of them: cells and points wait in one
/// queue, whose order computes both distances at every comparison.
Eigen::MatrixXi nearest(const Eigen::MatrixXd& points, const Octree& tree, int queries, int k);

/// Delaunay triangles of points in the plane, no three of which need be in general position: the points are added from
/// left to right, then edges are flipped, all over again until none asks for it. Exact predicates (CGAL).
Eigen::MatrixXi delaunay(const Eigen::MatrixXd& plane);

}  // namespace author
