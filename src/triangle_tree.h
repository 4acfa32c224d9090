// Triangles in leaves of four under a tree of boxes with eight children each, both laid out for vector registers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "box_tree.h"
#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

constexpr int leaf_triangles = 4;

/// Four triangles, each in an orthonormal frame of its own: its corners are (0, 0), (base, 0) and (apex, height) along
/// u and v from the origin. The base is the longest side, so that 0 ≤ apex ≤ base, and no needle is too thin for the
/// frame; a triangle without area is a flat one, height = 0. Places beyond the last triangle repeat it.
struct alignas(32) TriangleLeaf {
    double origin[3][leaf_triangles], u[3][leaf_triangles], v[3][leaf_triangles], n[3][leaf_triangles];
    double base[leaf_triangles], apex[leaf_triangles], height[leaf_triangles];
    /// 1 / squared length of the sides from the base's start and from its end to the apex, 0 where that is 0.
    double per_start[leaf_triangles], per_end[leaf_triangles];
    std::int32_t face[leaf_triangles];
};

/// levels[0][i] holds the boxes of the leaves 8i … 8i + 7, levels[l][i] those of the nodes 8i … 8i + 7 of levels[l −
/// 1]; the last level has one node. The shape depends on the number of triangles alone, so no input makes it deep.
struct TriangleTree {
    std::vector<TriangleLeaf> leaves;
    std::vector<std::vector<Boxes>> levels;
};

/// Of at least one triangle, all corners finite. Time O(n log n); memory 160 bytes a triangle.
TriangleTree triangle_tree(Points vertices, Triangles faces, const Execution& run);

/// The point of the triangle in place slot % 4 of leaf slot / 4 that is closest to q, as q − point in the frame.
struct Offset {
    double x, y, z;  ///< along u, v, n
    double squared() const { return x * x + y * y + z * z; }
};
Offset closest_offset(const TriangleTree& tree, std::uint32_t slot, Vec3 q);

/// That point.
Vec3 closest_point(const TriangleTree& tree, std::uint32_t slot, Vec3 q);

}  // namespace gaussmap
