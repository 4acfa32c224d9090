// Exact k nearest neighbours by a balanced kd-tree of buckets.
//
// Friedman, Bentley, Finkel, "An Algorithm for Finding Best Matches in Logarithmic Expected Time", 1977, with the
// points stored in leaf order. Node i of level l holds the entries [n i / 2^l, n (i + 1) / 2^l): the shape depends on n
// alone, so no input makes the tree deep. Every comparison of distances breaks ties by index, also where a whole node
// is weighed (its lowest index), so that equal points and grids neither change the answer nor slow it down.
#include "gaussmap/neighbors.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "check_cloud.h"
#include "parallel.h"
#include "vec.h"

namespace gaussmap {
namespace {

constexpr std::size_t leaf_size = 16;
constexpr std::int32_t nobody = std::numeric_limits<std::int32_t>::max();

struct Entry {
    double p[3];
    std::int32_t index;
};

/// The box of some entries and the lowest index among them.
struct Node {
    double low[3], high[3];
    std::int32_t first;
};

struct Found {
    double distance = std::numeric_limits<double>::infinity();  ///< squared
    std::int32_t index = nobody;
};

bool nearer(const Found& a, const Found& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.index < b.index);
}

/// The best candidates so far, sorted.
class Best {
  public:
    explicit Best(std::size_t k) : list_(k) {}
    void clear() { std::fill(list_.begin(), list_.end(), Found()); }
    bool wants(const Found& candidate) const { return nearer(candidate, list_.back()); }
    void insert(const Found& candidate) {
        std::size_t at = list_.size() - 1;
        for (; at > 0 && nearer(candidate, list_[at - 1]); --at) list_[at] = list_[at - 1];
        list_[at] = candidate;
    }
    const std::vector<Found>& list() const { return list_; }

  private:
    std::vector<Found> list_;
};

class Tree {
  public:
    Tree(Points points, const Execution& run);

    std::size_t leaves() const { return std::size_t(1) << levels_; }
    const Entry* begin(std::size_t leaf) const { return entries_.data() + start(levels_, leaf); }
    const Entry* end(std::size_t leaf) const { return begin(leaf + 1); }

    /// The nearest of an entry of a leaf: its own bucket first, then outwards through its ancestors' other children.
    void search(const Entry& query, std::size_t leaf, Best& best) const {
        best.clear();
        scan(query, leaf, best);
        for (std::size_t node = leaves() + leaf; node > 1; node /= 2)
            visit(query, node ^ 1, bound(query, node ^ 1), best);
    }

  private:
    std::size_t start(int level, std::size_t i) const { return (entries_.size() * i) >> level; }
    void split(int level, std::size_t i);
    void scan(const Entry& query, std::size_t leaf, Best& best) const;
    void visit(const Entry& query, std::size_t node, const Found& lower, Best& best) const;
    Found bound(const Entry& query, std::size_t node) const;

    std::vector<Entry> entries_;
    std::vector<Node> nodes_;  ///< a heap: the root is 1, the children of i are 2i and 2i + 1
    int levels_ = 0;
};

Tree::Tree(Points points, const Execution& run) : entries_(points.count) {
    for (std::size_t i = 0; i < points.count; ++i) {
        const double* p = points[i];
        if (!finite(load(p)))
            throw std::invalid_argument("points[" + std::to_string(i) + "] is not finite; leave such points out first");
        entries_[i] = {{p[0], p[1], p[2]}, static_cast<std::int32_t>(i)};
    }
    while ((points.count >> levels_) > leaf_size) ++levels_;
    nodes_.resize(2 * leaves());
    for (int level = 0; level <= levels_; ++level) {
        const std::size_t count = std::size_t(1) << level;
        const Execution part = part_of(run, double(level) / (levels_ + 1), double(level + 1) / (levels_ + 1));
        for_blocks(count, std::max<std::size_t>(1, count / 64), part,
                   [&](std::size_t, std::size_t i, std::size_t last) {
                       for (; i < last; ++i) split(level, i);
                   });
    }
}

/// Fill in node i of a level and, above the leaves, part its entries at the median of its widest dimension.
void Tree::split(int level, std::size_t i) {
    const auto first = entries_.begin() + static_cast<std::ptrdiff_t>(start(level, i));
    const auto last = entries_.begin() + static_cast<std::ptrdiff_t>(start(level, i + 1));
    Node node = {{first->p[0], first->p[1], first->p[2]}, {first->p[0], first->p[1], first->p[2]}, first->index};
    for (auto entry = first; entry != last; ++entry) {
        for (int c = 0; c < 3; ++c) {
            node.low[c] = std::min(node.low[c], entry->p[c]);
            node.high[c] = std::max(node.high[c], entry->p[c]);
        }
        node.first = std::min(node.first, entry->index);
    }
    nodes_[(std::size_t(1) << level) + i] = node;
    if (level == levels_) return;
    int widest = 0;
    for (int c = 1; c < 3; ++c)
        if (node.high[c] - node.low[c] > node.high[widest] - node.low[widest]) widest = c;
    const auto middle = entries_.begin() + static_cast<std::ptrdiff_t>(start(level + 1, 2 * i + 1));
    std::nth_element(first, middle, last, [widest](const Entry& a, const Entry& b) {
        return a.p[widest] < b.p[widest] || (a.p[widest] == b.p[widest] && a.index < b.index);
    });
}

void Tree::scan(const Entry& query, std::size_t leaf, Best& best) const {
    for (const Entry *entry = begin(leaf), *last = end(leaf); entry != last; ++entry) {
        const double dx = entry->p[0] - query.p[0], dy = entry->p[1] - query.p[1], dz = entry->p[2] - query.p[2];
        const Found candidate = {dx * dx + dy * dy + dz * dz, entry->index};
        if (best.wants(candidate) && candidate.index != query.index) best.insert(candidate);
    }
}

/// No entry of the node comes before this: rounding is monotone, so the bound holds in floating point too.
Found Tree::bound(const Entry& query, std::size_t i) const {
    const Node& node = nodes_[i];
    const auto gap = [&](int c) {
        return std::max(std::max(node.low[c] - query.p[c], query.p[c] - node.high[c]), 0.0);
    };
    const double dx = gap(0), dy = gap(1), dz = gap(2);
    return {dx * dx + dy * dy + dz * dz, node.first};
}

void Tree::visit(const Entry& query, std::size_t node, const Found& lower, Best& best) const {
    if (!best.wants(lower)) return;
    if (node >= leaves()) return scan(query, node - leaves(), best);
    const std::size_t left = 2 * node, right = 2 * node + 1;
    const Found left_bound = bound(query, left), right_bound = bound(query, right);
    if (nearer(right_bound, left_bound)) {
        visit(query, right, right_bound, best);
        visit(query, left, left_bound, best);
    } else {
        visit(query, left, left_bound, best);
        visit(query, right, right_bound, best);
    }
}

}  // namespace

Neighbors nearest_neighbors(Points points, int k, const Execution& run) {
    if (k < 1) throw std::invalid_argument("k = " + std::to_string(k) + " is too small; ask for at least 1 neighbour");
    check_countable(points);
    Neighbors neighbors;
    neighbors.k = static_cast<std::size_t>(k);
    neighbors.index.assign(points.count * neighbors.k, -1);
    if (points.count == 0) return neighbors;
    const Tree tree(points, part_of(run, 0, 0.3));
    const std::size_t others = std::min(neighbors.k, points.count - 1);
    if (others == 0) return neighbors;
    for_blocks(tree.leaves(), 64, part_of(run, 0.3, 1), [&](std::size_t, std::size_t leaf, std::size_t last) {
        Best best(others);
        for (; leaf < last; ++leaf)
            for (const Entry* query = tree.begin(leaf); query != tree.end(leaf); ++query) {
                tree.search(*query, leaf, best);
                std::int32_t* row = neighbors.index.data() + static_cast<std::size_t>(query->index) * neighbors.k;
                for (std::size_t j = 0; j < others; ++j) row[j] = best.list()[j].index;
            }
    });
    return neighbors;
}

}  // namespace gaussmap
