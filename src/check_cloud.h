// Checks of what comes with clouds at the library's border; messages name the array, the index and the value.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// \throw std::invalid_argument on more points than 32-bit indices can name.
inline void check_countable(Points points) {
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (points.count > most)
        throw std::invalid_argument("points has " + std::to_string(points.count) + " entries, more than " +
                                    std::to_string(most) + "; split the cloud");
}

/// Rows of k neighbours, as `Neighbors` holds them.
/// \throw std::invalid_argument unless there is one row for each point and every index is −1 or one of the points.
inline void check_neighbors(const std::vector<std::int32_t>& index, std::size_t k, std::size_t points) {
    if (index.size() != k * points)
        throw std::invalid_argument("neighbors has " + std::to_string(index.size()) + " entries, but there are " +
                                    std::to_string(points) + " points with " + std::to_string(k) + " each");
    for (std::size_t i = 0; i < points; ++i)
        for (std::size_t j = 0; j < k; ++j)
            if (const std::int32_t n = index[i * k + j]; n < -1 || n >= static_cast<std::int64_t>(points))
                throw std::invalid_argument("neighbors[" + std::to_string(i) + "][" + std::to_string(j) + "] = " +
                                            std::to_string(n) + " is outside [-1, " + std::to_string(points) + ")");
}

/// \throw std::invalid_argument on a degree of jets that there is not.
inline void check_degree(int degree) {
    if (degree < 1 || degree > 4)
        throw std::invalid_argument("degree = " + std::to_string(degree) + " is outside 1 to 4");
}

}  // namespace gaussmap
