// What clouds are measured against.
#pragma once

#include <vector>

#include "gaussmap/types.h"

/// Density of every point by a program built the way the author's is: for each point, one after the other, a query in a
/// tree of nodes, a plane through the neighbours from dynamic matrices (Eigen), normals turned to the centre's (no
/// spanning tree: that would only cost more), a whole Delaunay triangulation of the projected neighbours (CGAL), and
/// for each of its triangles at the point a sparse cotangent matrix.
std::vector<double> textbook_cloud(gaussmap::Points points, int k);

/// pc1² + pc2² of every point by PCL's NormalEstimation and PrincipalCurvaturesEstimation.
std::vector<double> pcl_cloud(gaussmap::Points points, int k);
