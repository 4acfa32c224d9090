// Checks of arrays at the library's border; messages name the array, the index and the value.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

#include "gaussmap/types.h"

namespace gaussmap {

/// The highest index of faces [begin, end), read as unsigned: a negative one is beyond any number of vertices. No
/// branch that would keep the loop scalar.
inline std::uint32_t highest_index(Triangles faces, std::size_t begin, std::size_t end) {
    std::uint32_t highest = 0;
    for (std::size_t i = 3 * begin; i < 3 * end; ++i)
        highest = std::max(highest, static_cast<std::uint32_t>(faces.abc[i]));
    return highest;
}

/// Whether every index of faces [begin, end) lies in [0, vertices).
inline bool faces_within(Triangles faces, std::size_t begin, std::size_t end, std::size_t vertices) {
    return begin == end || highest_index(faces, begin, end) < std::min<std::size_t>(vertices, 0x80000000u);
}

/// \throw std::invalid_argument at the first index outside [0, vertices).
inline void check_faces(Triangles faces, std::size_t vertices) {
    for (std::size_t f = 0; f < faces.count; ++f) {
        if (faces_within(faces, f, f + 1, vertices)) continue;
        int corner = 0;
        while (faces[f][corner] >= 0 && static_cast<std::size_t>(faces[f][corner]) < vertices) ++corner;
        throw std::invalid_argument("faces[" + std::to_string(f) + "][" + std::to_string(corner) +
                                    "] = " + std::to_string(faces[f][corner]) + " is outside [0, " +
                                    std::to_string(vertices) + ")");
    }
}

/// \throw std::invalid_argument unless there are `expected` items.
inline void check_count(const char* array, std::size_t count, std::size_t expected, const char* of) {
    if (count == expected) return;
    throw std::invalid_argument(std::string(array) + " has " + std::to_string(count) + " entries, but there are " +
                                std::to_string(expected) + " " + of);
}

}  // namespace gaussmap
