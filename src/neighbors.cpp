// Exact k nearest neighbours: groups of queries through the tree (neighbor_tree.h) by the best kernel for the machine
// (neighbor_search.h).
#include "gaussmap/neighbors.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

#include "check_cloud.h"
#include "neighbor_search.h"
#include "parallel.h"

namespace gaussmap {
namespace {

NearestKernel best_kernel() {
#ifdef GAUSSMAP_X86
    if (__builtin_cpu_supports("avx2")) return nearest_kernel_avx2;
#endif
    return nearest_kernel_baseline;
}

/// Owns what a SearchRoom points to.
class Room {
  public:
    Room(const NeighborTree& tree, std::size_t k)
        : capacity_(2 * k + 2 * leaf_points),
          most_leaves_(256 + k),
          distance_(capacity_ + leaf_points),
          key_((capacity_ + 31) / 32 * 32),
          spare_(key_.size()),
          found_distance_(leaf_points * k),
          boxes_(6 * most_leaves_ + leaf_points),
          index_(capacity_ + leaf_points),
          found_(leaf_points * k),
          nodes_(2 * most_leaves_) {
        for (const auto& level : tree.levels) levels_.push_back(level.data());
        view = {tree.leaves.data(),
                levels_.data(),
                static_cast<int>(levels_.size()),
                k,
                capacity_,
                most_leaves_,
                distance_.data(),
                index_.data(),
                key_.data(),
                spare_.data(),
                found_distance_.data(),
                found_.data(),
                {nodes_.data(), nodes_.data() + most_leaves_},
                boxes_.data(),
                std::numeric_limits<double>::infinity()};
    }
    SearchRoom view;

  private:
    std::size_t capacity_, most_leaves_;
    std::vector<double> distance_, key_, spare_, found_distance_, boxes_;
    std::vector<std::int32_t> index_, found_;
    std::vector<std::uint32_t> nodes_;
    std::vector<const Boxes*> levels_;
};

}  // namespace

Neighbors nearest_neighbors(Points points, int k, const Execution& run) {
    if (k < 1) throw std::invalid_argument("k = " + std::to_string(k) + " is too small; ask for at least 1 neighbour");
    check_countable(points);
    Neighbors neighbors;
    neighbors.k = static_cast<std::size_t>(k);
    neighbors.index.assign(points.count * neighbors.k, -1);
    if (points.count == 0) return neighbors;
    const NeighborTree tree = neighbor_tree(points, part_of(run, 0, 0.3));
    const std::size_t others = std::min(neighbors.k, points.count - 1);
    if (others == 0) return neighbors;
    const NearestKernel nearest = best_kernel();
    for_blocks(tree.leaves.size(), 256, part_of(run, 0.3, 1), [&](std::size_t, std::size_t l, std::size_t last) {
        Room room(tree, others + 1);
        for (; l < last; ++l) {
            const Leaf& leaf = tree.leaves[l];
            QueryGroup group;
            group.count = static_cast<int>(std::min<std::size_t>(leaf_points, points.count - l * leaf_points));
            std::copy(&leaf.p[0][0], &leaf.p[0][0] + 3 * leaf_points, &group.p[0][0]);
            nearest(room.view, group);
            for (int q = 0; q < group.count; ++q) {
                const std::int32_t self = leaf.index[q];
                std::int32_t* row = neighbors.index.data() + static_cast<std::size_t>(self) * neighbors.k;
                const std::int32_t* found = room.view.found + static_cast<std::size_t>(q) * (others + 1);
                const std::int32_t* at = std::find(found, found + others, self);
                std::copy(found, at, row);
                std::copy(at + 1, found + others + 1, row + (at - found));
            }
        }
    });
    return neighbors;
}

}  // namespace gaussmap
