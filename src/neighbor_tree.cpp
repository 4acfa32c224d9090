// The tree of neighbor_tree.h: 128 points in a row of the spatial order make the leaves of one node, parted at medians;
// nodes above join eight in a row.
#include "neighbor_tree.h"

#include <algorithm>
#include <utility>

#include "gaussmap/neighbors.h"
#include "parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t bunch = std::size_t{leaf_points} * children;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Store up to 16 entries as a leaf, and its box as child c.
void fill(const Entry* first, std::size_t count, Leaf& leaf, Boxes& boxes, int c) {
    for (std::size_t i = 0; i < leaf_points; ++i) {
        const bool there = i < count;
        for (int a = 0; a < 3; ++a) {
            leaf.p[a][i] = there ? first[i].p[a] : infinity;
            if (!there) continue;
            boxes.low[a][c] = std::min(boxes.low[a][c], first[i].p[a]);
            boxes.high[a][c] = std::max(boxes.high[a][c], first[i].p[a]);
        }
        leaf.index[i] = there ? first[i].index : nobody;
        boxes.first[c] = std::min(boxes.first[c], leaf.index[i]);
    }
}

}  // namespace

NeighborTree neighbor_tree(Points points, const Execution& run) {
    return neighbor_tree(points, spatial_order(points, part_of(run, 0, 0.5)), part_of(run, 0.5, 1));
}

NeighborTree neighbor_tree(Points points, const std::vector<std::int32_t>& order, const Execution& run) {
    NeighborTree tree;
    tree.count = order.size();
    tree.leaves.resize(block_count(tree.count, leaf_points));
    tree.levels.emplace_back(block_count(tree.count, bunch), no_boxes());
    for_blocks(tree.levels[0].size(), 64, run, [&](std::size_t, std::size_t b, std::size_t last) {
        for (; b < last; ++b) {
            Entry entries[bunch];
            const std::size_t begin = b * bunch, count = std::min(bunch, tree.count - begin);
            for (std::size_t i = 0; i < count; ++i) {
                const std::int32_t index = order[begin + i];
                const double* p = points[static_cast<std::size_t>(index)];
                entries[i] = {{p[0], p[1], p[2]}, index};
            }
            part(entries, entries + count, leaf_points);
            for (std::size_t i = 0; i < count; i += leaf_points)
                fill(entries + i, std::min<std::size_t>(leaf_points, count - i), tree.leaves[(begin + i) / leaf_points],
                     tree.levels[0][b], static_cast<int>(i / leaf_points));
        }
    });
    while (tree.levels.back().size() > 1) tree.levels.push_back(join(tree.levels.back()));
    return tree;
}

std::vector<std::int32_t> renumber(NeighborTree& tree) {
    std::vector<std::int32_t> source(tree.count);
    for (std::size_t place = 0; place < tree.count; ++place)
        source[place] = std::exchange(tree.leaves[place / leaf_points].index[place % leaf_points],
                                      static_cast<std::int32_t>(place));
    // The lowest index below a node is now that of the first point below it.
    std::size_t points_a_child = leaf_points;
    for (std::vector<Boxes>& level : tree.levels) {
        for (std::size_t i = 0; i < level.size() * children; ++i)
            if (i * points_a_child < tree.count)
                level[i / children].first[i % children] = static_cast<std::int32_t>(i * points_a_child);
        points_a_child *= children;
    }
    return source;
}

}  // namespace gaussmap
