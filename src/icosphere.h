// The unit sphere from an icosahedron whose faces are split in four again and again.
#pragma once

#include <cstdint>
#include <vector>

namespace gaussmap {

struct Icosphere {
    std::vector<double> directions;   ///< unit, 3 a vertex
    std::vector<std::int32_t> faces;  ///< 3 a face, counterclockwise seen from outside
};

/// 10·4^s + 2 vertices, 20·4^s faces; 0 ≤ subdivisions ≤ 12. A new vertex is the midpoint of an edge of the level
/// before, pushed to the sphere. Vertices and faces run row by row through each face of the icosahedron.
Icosphere icosphere(int subdivisions);

}  // namespace gaussmap
