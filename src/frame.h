// Directions: unit vectors, signs, and a right-handed frame about a normal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "vec.h"

namespace gaussmap {

/// a / |a| for any length that is neither zero nor infinite; NaN otherwise. A vector along an axis becomes that axis
/// exactly, so that the normals of a plane z = const agree to the last bit.
inline Vec3 unit(Vec3 a) {
    const double largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    if (!finite(a) || largest == 0) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        return {nan, nan, nan};
    }
    const Vec3 b = {a.x / largest, a.y / largest, a.z / largest};
    return (1 / length(b)) * b;
}

/// The one of ±n that looks up: z > 0, else y > 0, else x > 0.
inline Vec3 upward(Vec3 n) {
    const bool down = n.z < 0 || (n.z == 0 && (n.y < 0 || (n.y == 0 && n.x < 0)));
    return down ? -n : n;
}

struct Frame {
    Vec3 u, v, n;
};

/// A right-handed orthonormal frame about a unit normal, smooth but for z = 0, without a branch.
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
inline Frame frame_about(Vec3 n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace gaussmap
