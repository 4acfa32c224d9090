// Exact k nearest neighbours: groups of near queries go through the tree (neighbor_tree.h) together, by the best kernel
// for the machine (neighbor_search.h).
#include "gaussmap/neighbors.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "check_cloud.h"
#include "neighbor_rows.h"
#include "parallel.h"
#include "search_room.h"
#include "vec.h"

namespace gaussmap {
namespace {

constexpr std::size_t groups_a_block = 256;

void check_k(int k) {
    if (k < 1) throw std::invalid_argument("k = " + std::to_string(k) + " is too small; ask for at least 1 neighbour");
}

}  // namespace

Neighbors nearest_neighbors(Points points, int k, NearestKernel kernel, const Execution& run) {
    check_k(k);
    check_countable(points);
    Neighbors neighbors;
    neighbors.k = static_cast<std::size_t>(k);
    neighbors.index.assign(points.count * neighbors.k, -1);
    if (points.count == 0) return neighbors;
    const NeighborTree tree = neighbor_tree(points, part_of(run, 0, 0.3));
    const std::size_t others = std::min(neighbors.k, points.count - 1);
    for_blocks(tree.leaves.size(), groups_a_block, part_of(run, 0.3, 1),
               [&](std::size_t, std::size_t l, std::size_t last) {
                   NeighborRows search(tree, others, kernel);
                   for (; l < last; ++l) search.find(l, neighbors.index.data(), neighbors.k, 0);
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
