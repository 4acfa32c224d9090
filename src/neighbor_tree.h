// Points in leaves of 16 under a tree of boxes with eight children each, both laid out for vector registers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "box_tree.h"
#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

constexpr int leaf_points = 16;

/// Up to 16 points; places beyond are at infinity and belong to nobody.
struct alignas(64) Leaf {
    double p[3][leaf_points];
    std::int32_t index[leaf_points];
};

/// levels[0][i] holds the boxes of the leaves 8i … 8i + 7, levels[l][i] those of the nodes 8i … 8i + 7 of levels[l −
/// 1]; the last level has one node. The shape depends on the number of points alone, so no input makes the tree deep.
struct NeighborTree {
    std::size_t count = 0;  ///< points
    std::vector<Leaf> leaves;
    std::vector<std::vector<Boxes>> levels;

    /// The point in a place: in leaf place / 16.
    Vec3 at(std::size_t place) const {
        const Leaf& leaf = leaves[place / leaf_points];
        const std::size_t i = place % leaf_points;
        return {leaf.p[0][i], leaf.p[1][i], leaf.p[2][i]};
    }
};

/// \throw std::invalid_argument on a non-finite point or too many points. Time O(n) beyond `spatial_order`; memory 32
/// bytes a point, 20 more while it is built.
NeighborTree neighbor_tree(Points points, const Execution& run);

/// The same of some of the points, finite and given by index in their spatial order. Memory 32 bytes a point.
NeighborTree neighbor_tree(Points points, const std::vector<std::int32_t>& order, const Execution& run);

/// Number the points by their places in the leaves; the indices that they had.
std::vector<std::int32_t> renumber(NeighborTree& tree);

}  // namespace gaussmap
