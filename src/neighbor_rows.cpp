// Leaves are groups of near queries as they are.
#include "neighbor_rows.h"

#include <algorithm>
#include <bit>

#include "instruction_sets.h"
#include "search_room.h"

namespace gaussmap {
namespace {

/// Rows may be anywhere in memory; a word ahead has the first lines of one at hand when it is written.
void prefetch(const std::int32_t* row, std::size_t count) {
    for (std::size_t j = 0; j < std::min<std::size_t>(count, 32); j += 16) __builtin_prefetch(row + j, 1);
}

/// The results but the query itself, which comes first but for copies of it; enough of them leave it out.
void copy_others(const std::int32_t* found, std::size_t others, std::int32_t self, std::int32_t* row) {
    std::size_t j = 0;
    for (; j < others && found[j] != self; ++j) row[j] = found[j];
    for (; j < others; ++j) row[j] = found[j + 1];
}

}  // namespace

void order_tied(const SearchRoom& room, double* first, double* last) {
    std::sort(first, last, [&room](double a, double b) {
        const std::size_t i = std::bit_cast<std::uint64_t>(a) & room.places,
                          j = std::bit_cast<std::uint64_t>(b) & room.places;
        return nearer({room.distance[i], room.index[i]}, {room.distance[j], room.index[j]});
    });
}

NearestKernel best_kernel() {
    return GAUSSMAP_FASTEST(nearest_kernel);
}

NeighborRows::NeighborRows(const NeighborTree& tree, std::size_t k, NearestKernel kernel)
    : tree_(tree), kernel_(kernel), room_(std::make_unique<Room>(tree, k + 1)) {}

NeighborRows::~NeighborRows() = default;

void NeighborRows::find(std::size_t l, std::int32_t* rows, std::size_t stride, std::size_t first) {
    const Leaf& leaf = tree_.leaves[l];
    QueryGroup group;
    group.home = static_cast<std::int32_t>(l);
    group.count = static_cast<int>(std::min<std::size_t>(leaf_points, tree_.count - l * leaf_points));
    std::copy(leaf.p[0], leaf.p[0] + 3 * leaf_points, group.p[0]);
    SearchRoom& room = room_->view;
    const auto row = [&](std::size_t q) { return rows + (static_cast<std::size_t>(leaf.index[q]) - first) * stride; };
    const auto count = static_cast<std::size_t>(group.count);
    for (std::size_t q = 0; q < count; ++q) prefetch(row(q), room.k - 1);
    kernel_(room, group);
    for (std::size_t q = 0; q < count; ++q) copy_others(room.found + q * room.k, room.k - 1, leaf.index[q], row(q));
}

}  // namespace gaussmap
