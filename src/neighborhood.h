// The neighbours of one point, as differences from it.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lanes.h"
#include "vec.h"

namespace gaussmap {

/// The power of two that brings a length to [1, 2), as far as there is one; 1 where the length is 0.
inline double scale_of(double length) {
    if (length == 0) return 1;
    // Powers of two by their exponents: 1023 stands for 2⁰.
    const auto exponent = static_cast<int>(std::bit_cast<std::uint64_t>(length) >> 52);
    return std::bit_cast<double>(static_cast<std::uint64_t>(2046 - std::clamp(exponent, 23, 2023)) << 52);
}

inline Vec3 position(const double* p) {
    return load(p);
}
inline Vec3 position(Vec3 p) {
    return p;
}

/// Differences from a point, scaled by a power of two (so exactly) to a size near 1: squares and fourth powers of them
/// neither overflow nor underflow whatever the unit of length, and a large common offset costs nothing.
/// A coordinate an array, filled up with zeros to whole groups of lanes.
struct Neighborhood {
    std::vector<double> x, y, z;      ///< scale · (neighbour − point); the largest coordinate is in [1, 2)
    std::vector<std::int32_t> index;  ///< of the neighbour
    std::size_t count = 0;
    double scale = 1;

    explicit Neighborhood(std::size_t k) : x(padded(k)), y(x.size()), z(x.size()), index(k) {}

    Vec3 offset(std::size_t j) const { return {x[j], y[j], z[j]}; }

    /// Neighbours are taken from a row of `most` (up to k) indices, up to its first −1; none where the differences
    /// overflow. `points[i]` is a position.
    template <class Positions>
    void gather(const Positions& points, std::size_t centre, const std::int32_t* row, std::size_t most) {
        const Vec3 origin = position(points[centre]);
        Vec3 largest;
        for (count = 0; count < most && row[count] >= 0; ++count) {
            const Vec3 d = position(points[static_cast<std::size_t>(row[count])]) - origin;
            largest.x = std::max(largest.x, std::abs(d.x));
            largest.y = std::max(largest.y, std::abs(d.y));
            largest.z = std::max(largest.z, std::abs(d.z));
            x[count] = d.x, y[count] = d.y, z[count] = d.z;
            index[count] = row[count];
        }
        rescale(std::max({largest.x, largest.y, largest.z}));
        for (std::size_t j = count; j < padded(count); ++j) x[j] = y[j] = z[j] = 0;
    }

  private:
    void rescale(double largest) {
        if (!std::isfinite(largest)) count = 0;
        scale = count > 0 ? scale_of(largest) : 1;
        for (std::size_t j = 0; j < count; ++j) x[j] *= scale, y[j] *= scale, z[j] *= scale;
    }
};

}  // namespace gaussmap
