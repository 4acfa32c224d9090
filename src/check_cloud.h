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
/// \throw std::invalid_argument unless there is one for each point and every index is −1 or one of the points.
inline void check_neighbors(const std::vector<std::int32_t>& index, std::size_t k, std::size_t points) {
    const std::size_t rows = k == 0 ? 0 : index.size() / k;
    if (rows != points)
        throw std::invalid_argument("neighbors has " + std::to_string(rows) + " rows, but there are " +
                                    std::to_string(points) + " points");
    for (std::size_t i = 0; i < index.size(); ++i)
        if (index[i] < -1 || index[i] >= static_cast<std::int64_t>(points))
            throw std::invalid_argument("neighbors[" + std::to_string(i / k) + "][" + std::to_string(i % k) + "] = " +
                                        std::to_string(index[i]) + " is outside [-1, " + std::to_string(points) + ")");
}

/// \throw std::invalid_argument on a degree of jets that there is not.
inline void check_degree(int degree) {
    if (degree < 1 || degree > 4)
        throw std::invalid_argument("degree = " + std::to_string(degree) + " is outside 1 to 4");
}

}  // namespace gaussmap
