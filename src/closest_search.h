// The search for the closest of many triangles, compiled for several instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "triangle_tree.h"

namespace gaussmap {

/// What the search reads.
struct ClosestRoom {
    const TriangleLeaf* leaves;
    const Boxes* const* levels;  ///< as of TriangleTree
    int level_count;
    const double* queries;  ///< finite, 3 each
};

/// For each query order[0], …, order[count − 1], which are best near each other in a row: its squared distance and the
/// slot of its closest triangle, of equally close ones the first face, at the query's own place in the arrays.
using ClosestKernel = void (*)(const ClosestRoom& room, const std::int32_t* order, std::size_t count,
                               double* squared_distance, std::uint32_t* slot);
extern const ClosestKernel closest_kernel_baseline;
extern const ClosestKernel closest_kernel_avx2;

}  // namespace gaussmap
