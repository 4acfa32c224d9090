// The nearest of every point of a tree, a leaf at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "neighbor_search.h"
#include "neighbor_tree.h"

namespace gaussmap {

class Room;  // search_room.h

/// What the machine runs fastest.
NearestKernel best_kernel();

/// What a thread works with to find the k nearest others; k is below the number of points.
class NeighborRows {
  public:
    NeighborRows(const NeighborTree& tree, std::size_t k, NearestKernel kernel = best_kernel());
    ~NeighborRows();

    /// For every point of a leaf, a row of k indices, nearest first, equal distances by smaller index: that of point i
    /// begins at rows[(i − first) · stride].
    void find(std::size_t leaf, std::int32_t* rows, std::size_t stride, std::size_t first);

  private:
    const NeighborTree& tree_;
    NearestKernel kernel_;
    std::unique_ptr<Room> room_;
};

}  // namespace gaussmap
