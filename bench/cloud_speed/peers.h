// What clouds are measured against.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/types.h"

/// Microseconds of work a point, of the parts of a program built like the author's.
struct AuthorWork {
    double octree, search, plane, delaunay, energy;

    double all() const { return octree + search + plane + delaunay + energy; }
};

/// What that program finds at the first points of a cloud, a row each, and what it took.
struct AuthorCloud {
    std::vector<double> density;
    std::vector<int> neighbors;                   ///< k, the point itself the first of them
    std::vector<double> planes;                   ///< k places in the plane
    std::vector<int> triangles, triangle_counts;  ///< of the plane, by their places in `neighbors`
    AuthorWork work;
};

/// A program built like the author's (author.h): an octree of all points; at the first `queries` of them the k nearest,
/// the plane through them from dynamic matrices (Eigen), their whole Delaunay triangulation by flips, and for each of
/// its triangles at the point a sparse cotangent matrix and three quadratic forms with the normals given.
AuthorCloud author_cloud(gaussmap::Points points, gaussmap::Points normals, std::size_t queries, int k);

/// Density of every point by the same recipe with a textbook's means, a kinder program than the author's: a kd-tree of
/// one point a node, a plane and a normal from the neighbours' covariance, normals turned to the centre's (no spanning
/// tree: that would only cost more), CGAL's own Delaunay triangulation, and a sparse cotangent matrix a triangle.
std::vector<double> textbook_cloud(gaussmap::Points points, int k);

/// pc1² + pc2² of every point by PCL's NormalEstimation and PrincipalCurvaturesEstimation.
std::vector<double> pcl_cloud(gaussmap::Points points, int k);
