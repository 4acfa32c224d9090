// What a ClosestIndex holds: triangles or points under a tree, and queries in the order that suits them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "closest_search.h"
#include "gaussmap/distance.h"
#include "gaussmap/neighbors.h"
#include "triangle_tree.h"
#include "vec.h"

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

/// Call body(p) for the vertices that faces use, as often as they do; for all where there are no faces.
template <class Body>
void for_surface_points(Points vertices, Triangles faces, Body&& body) {
    for (std::size_t i = 0; i < 3 * faces.count; ++i) body(load(vertices[static_cast<std::size_t>(faces.abc[i])]));
    for (std::size_t v = 0; faces.empty() && v < vertices.count; ++v) body(load(vertices[v]));
}

/// The largest absolute coordinate of the vertices that faces use, of all where there are no faces.
double reach(Points vertices, Triangles faces);

/// By a given kernel, for the tests: squared distances and faces.
struct ClosestFaces {
    std::vector<double> squared;
    std::vector<std::int32_t> face;
};
ClosestFaces closest_faces(Points vertices, Triangles faces, Points queries, ClosestKernel kernel);

}  // namespace gaussmap
