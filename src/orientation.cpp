// Orientation of normals along the minimum spanning forest of the neighbour graph (Hoppe et al. 1992, section 3.3).
//
// The forest is Borůvka's (Nešetřil, Milková, Nešetřilová, "Otakar Borůvka on minimum spanning tree problem", 2001):
// every round each part takes its lightest edge to another part. It needs neither the edges sorted nor the graph
// symmetrised, so it works on the neighbours as they are and some forty bytes a point. Edges are ordered by weight,
// then by their ends, which makes the forest unique.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "check.h"
#include "check_cloud.h"
#include "frame.h"
#include "gaussmap/normals.h"
#include "parallel.h"

namespace gaussmap {
namespace {

using Index = std::int32_t;
using Forest = std::vector<std::pair<Index, Index>>;

struct Edge {
    double weight = std::numeric_limits<double>::infinity();
    Index low = 0, high = 0;

    bool none() const { return low == high; }
    bool operator<(const Edge& other) const {
        return std::tie(weight, low, high) < std::tie(other.weight, other.low, other.high);
    }
};

Index root_of(std::vector<Index>& part, Index i) {
    while (part[i] != i) i = part[i] = part[part[i]];
    return i;
}

/// The lightest edge out of every part, kept at the part's root.
void lightest_edges(const Neighbors& neighbors, const std::vector<double>& normals, const std::vector<Index>& part,
                    std::vector<Edge>& lightest) {
    std::fill(lightest.begin(), lightest.end(), Edge());
    for (std::size_t i = 0; i < part.size(); ++i) {
        const Vec3 normal = load(normals.data() + 3 * i);
        if (!finite(normal)) continue;
        const Index* row = neighbors[i];
        for (std::size_t n = 0; n < neighbors.k && row[n] >= 0; ++n) {
            const auto j = static_cast<std::size_t>(row[n]);
            if (part[i] == part[j]) continue;
            const double agreement = dot(normal, load(normals.data() + 3 * j));
            if (std::isnan(agreement)) continue;
            const Edge edge = {1 - std::abs(agreement), static_cast<Index>(std::min(i, j)),
                               static_cast<Index>(std::max(i, j))};
            if (edge < lightest[part[i]]) lightest[part[i]] = edge;
            if (edge < lightest[part[j]]) lightest[part[j]] = edge;
        }
    }
}

Forest spanning_forest(const Neighbors& neighbors, const std::vector<double>& normals, const Execution& run) {
    const std::size_t count = neighbors.count();
    std::vector<Index> part(count);
    std::iota(part.begin(), part.end(), 0);
    std::vector<Edge> lightest(count);
    Forest forest;
    forest.reserve(count);
    for (bool grown = true; grown;) {
        lightest_edges(neighbors, normals, part, lightest);
        grown = false;
        for (const Edge& edge : lightest) {
            if (edge.none()) continue;
            const Index a = root_of(part, edge.low), b = root_of(part, edge.high);
            if (a == b) continue;
            part[std::max(a, b)] = std::min(a, b);
            forest.emplace_back(edge.low, edge.high);
            grown = true;
        }
        for (std::size_t i = 0; i < count; ++i) part[i] = root_of(part, static_cast<Index>(i));
        const double done = static_cast<double>(forest.size()) / static_cast<double>(count);
        if (run.progress && !run.progress(done)) throw Cancelled();
    }
    return forest;
}

/// Neighbours in the forest: those of point i are other[begin[i]] … other[begin[i + 1] − 1].
struct Adjacency {
    std::vector<std::uint32_t> begin;
    std::vector<Index> other;

    Adjacency(const Forest& forest, std::size_t count) : begin(count + 1), other(2 * forest.size()) {
        for (const auto& [a, b] : forest) ++begin[a], ++begin[b];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        for (const auto& [a, b] : forest) {
            other[--begin[a]] = b;
            other[--begin[b]] = a;
        }
    }
};

}  // namespace

void orient_normals(Points points, const Neighbors& neighbors, std::vector<double>& normals, const Execution& run) {
    check_count("normals", normals.size() / 3, points.count, "points");
    check_neighbors(neighbors.index, neighbors.k, points.count);
    if (points.empty()) return;
    const Adjacency tree(spanning_forest(neighbors, normals, run), points.count);

    // From the highest point downwards: the first of each part that is met is its highest.
    std::vector<Index> order(points.count), reached;
    std::iota(order.begin(), order.end(), 0);
    const auto height = [&](Index i) {
        const Vec3 p = load(points[static_cast<std::size_t>(i)]);
        return finite(p) ? p.z : -std::numeric_limits<double>::infinity();
    };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        const double za = height(a), zb = height(b);
        return za > zb || (za == zb && a < b);
    });
    std::vector<bool> seen(points.count, false);
    for (const Index root : order) {
        if (seen[root]) continue;
        seen[root] = true;
        double* top = normals.data() + 3 * static_cast<std::size_t>(root);
        if (finite(load(top))) store(top, upward(load(top)));
        reached.assign(1, root);
        while (!reached.empty()) {
            const Index i = reached.back();
            reached.pop_back();
            const Vec3 normal = load(normals.data() + 3 * static_cast<std::size_t>(i));
            for (std::uint32_t e = tree.begin[i]; e < tree.begin[i + 1]; ++e) {
                const Index j = tree.other[e];
                if (seen[j]) continue;
                seen[j] = true;
                double* other = normals.data() + 3 * static_cast<std::size_t>(j);
                if (dot(normal, load(other)) < 0) store(other, -load(other));
                reached.push_back(j);
            }
        }
    }
}

}  // namespace gaussmap
