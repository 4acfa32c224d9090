// Checks of arrays at the library's border; messages name the array, the index and the value.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

#include "gaussmap/types.h"

namespace gaussmap {

/// Indices below this are right: read as unsigned, a negative index is a large one and beyond any number of vertices.
inline std::uint32_t index_limit(std::size_t vertices) {
    return static_cast<std::uint32_t>(std::min<std::size_t>(vertices, 0x80000000u));
}

/// Whether every index of faces [begin, end) lies in [0, vertices).
inline bool faces_within(Triangles faces, std::size_t begin, std::size_t end, std::size_t vertices) {
    // One comparison a value, and no branch that keeps the loop scalar.
    const std::uint32_t limit = index_limit(vertices);
    std::uint32_t bad = 0;
    for (std::size_t i = 3 * begin; i < 3 * end; ++i)
        bad |= static_cast<std::uint32_t>(faces.abc[i]) >= limit ? 1u : 0u;
    return bad == 0;
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
