// The arrays that a search works in.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "neighbor_search.h"

namespace gaussmap {

/// Owns what a SearchRoom points to.
class Room {
  public:
    Room(const NeighborTree& tree, std::size_t k)
        : distance_(2 * k + 3 * leaf_points),
          key_(distance_.size() + 32),
          spare_(key_.size()),
          found_distance_(leaf_points * k),
          boxes_(6 * (256 + k) + leaf_points),
          index_(distance_.size()),
          found_(leaf_points * k),
          nodes_(2 * (256 + k)) {
        for (const auto& level : tree.levels) levels_.push_back(level.data());
        view.leaves = tree.leaves.data();
        view.levels = levels_.data();
        view.level_count = static_cast<int>(levels_.size());
        view.k = k;
        view.capacity = distance_.size() - leaf_points;
        view.places = std::bit_ceil(view.capacity) - 1;
        view.most_leaves = nodes_.size() / 2;
        view.distance = distance_.data(), view.index = index_.data();
        view.key = key_.data(), view.spare = spare_.data();
        view.found_distance = found_distance_.data(), view.found = found_.data();
        view.nodes[0] = nodes_.data(), view.nodes[1] = nodes_.data() + view.most_leaves;
        view.boxes = boxes_.data();
    }
    SearchRoom view;

  private:
    std::vector<double> distance_, key_, spare_, found_distance_, boxes_;
    std::vector<std::int32_t> index_, found_;
    std::vector<std::uint32_t> nodes_;
    std::vector<const Boxes*> levels_;
};

}  // namespace gaussmap
