// Leaves are groups of near queries as they are.
#include "neighbor_rows.h"

#include <algorithm>

#include "search_room.h"

namespace gaussmap {
namespace {

/// The results but the query itself; it is not among them where enough copies of it come before.
void copy_others(const std::int32_t* found, std::size_t others, std::int32_t self, std::int32_t* row) {
    bool passed = false;
    for (std::size_t j = 0; j < others; ++j) {
        passed |= found[j] == self;
        row[j] = found[j + passed];
    }
}

}  // namespace

NearestKernel best_kernel() {
#ifdef GAUSSMAP_X86
    if (__builtin_cpu_supports("avx2")) return nearest_kernel_avx2;
#endif
    return nearest_kernel_baseline;
}

NeighborRows::NeighborRows(const NeighborTree& tree, std::size_t k, NearestKernel kernel)
    : tree_(tree), kernel_(kernel), room_(std::make_unique<Room>(tree, k + 1)) {}

NeighborRows::~NeighborRows() = default;

void NeighborRows::find(std::size_t l, std::int32_t* rows, std::size_t stride, std::size_t first) {
    const Leaf& leaf = tree_.leaves[l];
    QueryGroup group;
    group.count = static_cast<int>(std::min<std::size_t>(leaf_points, tree_.count - l * leaf_points));
    std::copy(leaf.p[0], leaf.p[0] + 3 * leaf_points, group.p[0]);
    SearchRoom& room = room_->view;
    kernel_(room, group);
    for (std::size_t q = 0; q < static_cast<std::size_t>(group.count); ++q)
        copy_others(room.found + q * room.k, room.k - 1, leaf.index[q],
                    rows + (static_cast<std::size_t>(leaf.index[q]) - first) * stride);
}

}  // namespace gaussmap
