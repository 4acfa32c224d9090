// A direction in two numbers: the sphere unfolded as an octahedron onto a square.
// Cigolle, Donow, Evangelakos, Mara, McGuire, Meyer, "A survey of efficient representations for independent unit
// vectors", Journal of Computer Graphics Techniques 3(2), 2014.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "vec.h"

namespace gaussmap {

/// Of any positive length; what has no direction becomes (−32768, −32768), which no direction does.
inline std::array<std::int16_t, 2> octahedral(Vec3 v) {
    const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    if (!(sum > 0) || !std::isfinite(sum)) return {-32768, -32768};
    double x = v.x / sum, y = v.y / sum;
    if (v.z < 0) {  // the lower half is folded outward over the edges
        const double folded = std::copysign(1 - std::abs(y), x);
        y = std::copysign(1 - std::abs(x), y), x = folded;
    }
    return {static_cast<std::int16_t>(std::lround(32767 * x)), static_cast<std::int16_t>(std::lround(32767 * y))};
}

}  // namespace gaussmap
