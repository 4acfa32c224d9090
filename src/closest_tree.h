// What a ClosestIndex holds: triangles or points under a tree, and queries in the order that suits them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "closest_search.h"
#include "gaussmap/distance.h"
#include "gaussmap/neighbors.h"
#include "triangle_tree.h"

namespace gaussmap {

struct ClosestTree {
    TriangleTree triangles;                ///< empty for a cloud
    std::unique_ptr<NeighborIndex> cloud;  ///< null for a surface
    std::vector<double> points;            ///< of the cloud
    double reach = 0;                      ///< largest absolute coordinate
};

/// Of each query, the squared distance, and the slot in the tree of triangles or the index of the point. `squared` and
/// `slot` have room for all. \throw std::invalid_argument as ClosestIndex::distances.
void find_closest(const ClosestTree& tree, Points queries, double* squared, std::uint32_t* slot, const Execution& run);

/// Squared distance of q from the triangle in a slot, or the point of that index.
double squared_distance(const ClosestTree& tree, std::uint32_t slot, Vec3 q);

/// \throw std::invalid_argument as ClosestIndex does.
void check_surface(Points vertices, Triangles faces);

/// The largest absolute coordinate of the vertices that faces use, of all where there are no faces.
double reach(Points vertices, Triangles faces);

/// By a given kernel, for the tests: squared distances and faces.
struct ClosestFaces {
    std::vector<double> squared;
    std::vector<std::int32_t> face;
};
ClosestFaces closest_faces(Points vertices, Triangles faces, Points queries, ClosestKernel kernel);

}  // namespace gaussmap
