// The search for the k nearest of a group of up to 16 near queries, compiled for several instruction sets.
#pragma once

#include "neighbor_tree.h"

namespace gaussmap {

/// The queries, in places [0, count) of each coordinate.
struct QueryGroup {
    double p[3][leaf_points];
    int count;
};

/// What a thread works with, made by `search_room`. Where k results are asked for, k is at most the tree's points.
struct SearchRoom {
    const Leaf* leaves;
    const Boxes* const* levels;  ///< as of NeighborTree
    int level_count;
    std::size_t k;
    std::size_t capacity;     ///< of candidates
    std::size_t most_leaves;  ///< that a group collects; beyond, its queries go one by one
    double* distance;         ///< candidates: squared distance
    std::int32_t* index;      ///<   and index
    double *key, *spare;      ///<   and what they are sorted by, up to a multiple of 32
    double* found_distance;   ///< k results of each query, nearest first
    std::int32_t* found;
    std::uint32_t* nodes[2];  ///< lists of nodes on the way down
    double* boxes;            ///< of the leaves collected: 6 arrays
    double typical;           ///< squared distance of the k-th nearest, from group to group; infinite at first
};

/// Fill `found` and `found_distance` for the queries of a group: the k nearest, equal distances by smaller index.
using NearestKernel = void (*)(SearchRoom& room, const QueryGroup& group);
extern const NearestKernel nearest_kernel_baseline;
extern const NearestKernel nearest_kernel_avx2;

}  // namespace gaussmap
