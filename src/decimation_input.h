// What of a mesh can be decimated, made ready for it.
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "positions are read as three doubles each");

/// The faces of three distinct finite corners and their vertices, in a box of diagonal 1 about the origin. Vertices and
/// faces are in an order of space: near ones are near each other in memory, and the order in the input matters no more.
struct DecimationInput {
    std::vector<Vec3> positions;
    std::vector<std::int32_t> corners;  ///< 3 a face
    std::vector<std::int32_t> faces;    ///< the input's index of each
    std::vector<std::int8_t> rotation;  ///< of each face: its first corner's place in the input's face
    Vec3 centre;
    double diagonal = 1;
    std::size_t degenerate = 0, non_finite = 0;  ///< faces left out

    Points points() const { return {positions.empty() ? nullptr : &positions.front().x, positions.size()}; }
};

DecimationInput decimation_input(Points vertices, Triangles faces, const Execution& run);

}  // namespace gaussmap
