// The search for the k nearest of a group of up to 16 near queries, compiled for several instruction sets.
#pragma once

#include "gaussmap/neighbors.h"
#include "neighbor_tree.h"

namespace gaussmap {

/// The queries, in places [0, count) of each coordinate.
struct QueryGroup {
    double p[3][leaf_points];
    int count;
    std::int32_t home;  ///< the leaf that they are the points of, or −1
};

/// What a thread works with.
struct SearchRoom {
    const Leaf* leaves = nullptr;
    const Boxes* const* levels = nullptr;  ///< as of NeighborTree
    int level_count = 0;
    std::size_t k = 0;              ///< results a query: 1 up to the number of points
    std::size_t capacity = 0;       ///< of candidates, at least k and a leaf; the arrays have room for a leaf more
    std::uint64_t places = 0;       ///< ones where a key has the candidate's place
    std::size_t most_leaves = 0;    ///< that a group collects; beyond, its queries go one by one
    double* distance = nullptr;     ///< candidates: squared distance
    std::int32_t* index = nullptr;  ///<   and index
    double *key = nullptr, *spare = nullptr;  ///<   and what they are sorted by, with room up to a multiple of 32
    double* found_distance = nullptr;         ///< k results of each query, nearest first
    std::int32_t* found = nullptr;
    std::uint32_t* nodes[2] = {};  ///< lists of most_leaves nodes on the way down
    double* boxes = nullptr;       ///< of the leaves collected: 6 arrays of most_leaves
    /// Squared distance of the k-th nearest, as queries go; infinite at first. It has no part in the results.
    double typical = std::numeric_limits<double>::infinity();
};

/// A candidate, or a bound of candidates: by squared distance, then by index.
struct Found {
    double distance;
    std::int32_t index;
};
static inline bool nearer(const Found& a, const Found& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.index < b.index);
}

/// Sort keys that differ in their places alone by what the candidates there are. Rare, so kept out of the kernels.
void order_tied(const SearchRoom& room, double* first, double* last);

/// Fill `found` and `found_distance` for the queries of a group: the k nearest, equal distances by smaller index.
using NearestKernel = void (*)(SearchRoom& room, const QueryGroup& group);
extern const NearestKernel nearest_kernel_baseline;
extern const NearestKernel nearest_kernel_avx2;

/// As the public one, by a given kernel.
Neighbors nearest_neighbors(Points points, int k, NearestKernel kernel, const Execution& run);

}  // namespace gaussmap
