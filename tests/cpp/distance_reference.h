// The definition of the distance to triangles and clouds, slowly and in long double, for the tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "gaussmap/distance.h"
#include "gaussmap/surfaces.h"
#include "support.h"

namespace support {

using Long3 = std::vector<long double>;

inline Long3 minus(const Long3& a, const Long3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline long double times(const Long3& a, const Long3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Long3 crossed(const Long3& a, const Long3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline long double to_segment(const Long3& q, const Long3& a, const Long3& b) {
    const Long3 along = minus(b, a), d = minus(q, a);
    const long double square = times(along, along);
    const long double t = square > 0 ? std::clamp<long double>(times(d, along) / square, 0, 1) : 0;
    const Long3 rest = {d[0] - t * along[0], d[1] - t * along[1], d[2] - t * along[2]};
    return std::sqrt(times(rest, rest));
}

/// The nearest of the sides, and the plane where q is above the inside.
inline long double to_triangle(const Long3& q, const Long3& a, const Long3& b, const Long3& c) {
    long double distance = std::min({to_segment(q, a, b), to_segment(q, b, c), to_segment(q, c, a)});
    const Long3 n = crossed(minus(b, a), minus(c, a));
    const long double square = times(n, n);
    if (square == 0) return distance;
    const auto inside = [&](const Long3& from, const Long3& to) {
        return times(crossed(minus(to, from), minus(q, from)), n) >= 0;
    };
    if (inside(a, b) && inside(b, c) && inside(c, a))
        distance = std::min(distance, std::abs(times(minus(q, a), n)) / std::sqrt(square));
    return distance;
}

/// A surface or, without faces, a cloud.
struct Shape {
    std::vector<double> vertices;
    std::vector<std::int32_t> faces;

    Long3 corner(std::size_t i) const {
        const double* p = &vertices[3 * i];
        return {p[0], p[1], p[2]};
    }
    long double distance(const double* at) const {
        const Long3 q = {at[0], at[1], at[2]};
        long double least = std::numeric_limits<long double>::infinity();
        for (std::size_t f = 0; f < faces.size(); f += 3)
            least = std::min(least, to_triangle(q, corner(static_cast<std::size_t>(faces[f])),
                                                corner(static_cast<std::size_t>(faces[f + 1])),
                                                corner(static_cast<std::size_t>(faces[f + 2]))));
        for (std::size_t v = 0; faces.empty() && v < vertices.size() / 3; ++v)
            least = std::min(least, to_segment(q, corner(v), corner(v)));
        return least;
    }
};

inline Shape shape_of(const gaussmap::Surface& surface) {
    return {surface.vertices, surface.faces};
}

}  // namespace support
