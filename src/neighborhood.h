// The neighbours of one point, as differences from it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

/// Differences from a point, scaled by a power of two (so exactly) to a size near 1: squares and fourth powers of them
/// neither overflow nor underflow whatever the unit of length, and a large common offset costs nothing.
struct Neighborhood {
    std::vector<Vec3> offset;         ///< scale · (neighbour − point)
    std::vector<std::int32_t> index;  ///< of the neighbour
    std::size_t count = 0;
    double scale = 1;

    explicit Neighborhood(std::size_t k) : offset(k), index(k) {}

    /// Neighbours are taken from a row of `Neighbors`, up to its first −1; none where the differences overflow.
    void gather(Points points, std::size_t centre, const std::int32_t* row) {
        const Vec3 origin = load(points[centre]);
        double largest = 0;
        for (count = 0; count < offset.size() && row[count] >= 0; ++count) {
            const Vec3 d = load(points[static_cast<std::size_t>(row[count])]) - origin;
            largest = std::max({largest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
            offset[count] = d;
            index[count] = row[count];
        }
        if (largest == 0 || !std::isfinite(largest)) {
            count = largest == 0 ? count : 0;
            scale = 1;
            return;
        }
        scale = std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
        for (std::size_t j = 0; j < count; ++j) offset[j] = scale * offset[j];
    }
};

}  // namespace gaussmap
