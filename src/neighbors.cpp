// Exact k nearest neighbours: groups of near queries go through the tree (neighbor_tree.h) together, by the best kernel
// for the machine (neighbor_search.h).
#include "gaussmap/neighbors.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

#include "check_cloud.h"
#include "neighbor_search.h"
#include "parallel.h"
#include "vec.h"

namespace gaussmap {
namespace {

constexpr std::size_t groups_a_block = 256;

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

void check_k(int k) {
    if (k < 1) throw std::invalid_argument("k = " + std::to_string(k) + " is too small; ask for at least 1 neighbour");
}

/// Rows are anywhere in memory; a word ahead has the first lines of one at hand when it is written.
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

Neighbors nearest_neighbors(Points points, int k, NearestKernel kernel, const Execution& run) {
    check_k(k);
    check_countable(points);
    Neighbors neighbors;
    neighbors.k = static_cast<std::size_t>(k);
    neighbors.index.assign(points.count * neighbors.k, -1);
    if (points.count == 0) return neighbors;
    const NeighborTree tree = neighbor_tree(points, part_of(run, 0, 0.3));
    const std::size_t others = std::min(neighbors.k, points.count - 1);
    for_blocks(
        tree.leaves.size(), groups_a_block, part_of(run, 0.3, 1), [&](std::size_t, std::size_t l, std::size_t last) {
            Room room(tree, others + 1);
            for (; l < last; ++l) {
                const Leaf& leaf = tree.leaves[l];
                QueryGroup group;
                group.home = static_cast<std::int32_t>(l);
                group.count = static_cast<int>(std::min<std::size_t>(leaf_points, points.count - l * leaf_points));
                std::copy(leaf.p[0], leaf.p[0] + 3 * leaf_points, group.p[0]);
                for (int q = 0; q < group.count; ++q)
                    prefetch(neighbors.index.data() + static_cast<std::size_t>(leaf.index[q]) * neighbors.k, others);
                kernel(room.view, group);
                for (int q = 0; q < group.count; ++q)
                    copy_others(room.view.found + static_cast<std::size_t>(q) * room.view.k, others, leaf.index[q],
                                neighbors.index.data() + static_cast<std::size_t>(leaf.index[q]) * neighbors.k);
            }
        });
    return neighbors;
}

Neighbors nearest_neighbors(Points points, int k, const Execution& run) {
    return nearest_neighbors(points, k, best_kernel(), run);
}

NeighborIndex::NeighborIndex(Points points, const Execution& run)
    : tree_(std::make_shared<const NeighborTree>(neighbor_tree(points, run))) {}

std::size_t NeighborIndex::count() const {
    return tree_->count;
}

NearestPoints NeighborIndex::nearest(Points queries, int k, bool distances, const Execution& run) const {
    check_k(k);
    if (queries.count > static_cast<std::size_t>(nobody))
        throw std::invalid_argument("queries has " + std::to_string(queries.count) + " entries, more than " +
                                    std::to_string(nobody) + "; split them");
    for (std::size_t i = 0; i < queries.count; ++i)
        if (!finite(load(queries[i])))
            throw std::invalid_argument("queries[" + std::to_string(i) +
                                        "] is not finite; leave such points out first");
    NearestPoints result;
    result.k = static_cast<std::size_t>(k);
    result.index.assign(queries.count * result.k, -1);
    if (distances) result.squared_distance.assign(result.index.size(), std::numeric_limits<double>::infinity());
    const std::size_t there = std::min(result.k, count());
    if (there == 0) return result;
    const std::vector<std::int32_t> order = spatial_order(queries, part_of(run, 0, 0.1));
    const NearestKernel kernel = best_kernel();
    const std::size_t block = groups_a_block * leaf_points;
    for_blocks(queries.count, block, part_of(run, 0.1, 1), [&](std::size_t, std::size_t first, std::size_t last) {
        Room room(*tree_, there);
        for (; first < last; first += leaf_points) {
            QueryGroup group{};
            group.home = -1;
            group.count = static_cast<int>(std::min<std::size_t>(leaf_points, last - first));
            for (int q = 0; q < group.count; ++q)
                for (int a = 0; a < 3; ++a)
                    group.p[a][q] = queries[static_cast<std::size_t>(order[first + static_cast<std::size_t>(q)])][a];
            kernel(room.view, group);
            for (int q = 0; q < group.count; ++q) {
                const std::size_t from = static_cast<std::size_t>(q) * there;
                const std::size_t row = static_cast<std::size_t>(order[first + static_cast<std::size_t>(q)]) * result.k;
                std::copy_n(room.view.found + from, there, result.index.data() + row);
                if (distances)
                    std::copy_n(room.view.found_distance + from, there, result.squared_distance.data() + row);
            }
        }
    });
    return result;
}

}  // namespace gaussmap
