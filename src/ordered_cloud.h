// The points of a cloud that work is done on: finite, each position once, near ones near each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"
#include "neighbor_tree.h"

namespace gaussmap {

/// A point at the position of an earlier one, by input indices.
struct Copy {
    std::int32_t index, first;
};

/// The finite points along a space-filling curve, each position once, by input indices.
struct SpatialOrder {
    std::vector<std::int32_t> first;  ///< the first holder of each position
    std::vector<Copy> copies;         ///< all others
    std::size_t non_finite = 0;
};

/// Some finite points along a space-filling curve, by the indices that they have among all.
/// \param some  each once, in ascending order.
std::vector<std::int32_t> spatial_order_of(Points points, const std::vector<std::int32_t>& some, const Execution& run);

/// The order depends on the positions alone, neither on copies nor on what is not finite.
/// \throw std::invalid_argument on more than 2³¹ − 1 points. Time O(n); memory 4 bytes a point, 20 while it works.
SpatialOrder distinct_order(Points points, const Execution& run);

/// The points in leaves, and only there: point i of the cloud is the one in place i of the tree.
struct OrderedCloud {
    NeighborTree tree;
    std::vector<std::int32_t> source;  ///< input index of each point
    std::vector<Copy> copies;
    std::size_t non_finite = 0;

    std::size_t count() const { return source.size(); }
    Vec3 operator[](std::size_t i) const { return tree.at(i); }
};

/// Memory 36 bytes a point.
OrderedCloud ordered_cloud(Points points, const Execution& run);

}  // namespace gaussmap
