// What of a mesh or a cloud is drawn, and its box.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

/// Call visit(point) for every point that is drawn: corners of faces without a non-finite one; points of a cloud.
template <class Visit>
void for_drawn(Points vertices, Triangles faces, Visit&& visit) {
    for (std::size_t f = 0; f < faces.count; ++f) {
        const Vec3 a = load(vertices[faces[f][0]]), b = load(vertices[faces[f][1]]), c = load(vertices[faces[f][2]]);
        if (finite(a) && finite(b) && finite(c)) visit(a), visit(b), visit(c);
    }
    if (!faces.empty()) return;
    for (std::size_t v = 0; v < vertices.count; ++v)
        if (const Vec3 p = load(vertices[v]); finite(p)) visit(p);
}

struct Box {
    Vec3 centre, sides;
    double diagonal() const { return std::hypot(sides.x, sides.y, sides.z); }
};

/// \throw std::invalid_argument where nothing is drawn, or across more than double precision spans.
inline Box box_of(Points vertices, Triangles faces) {
    constexpr double far = std::numeric_limits<double>::infinity();
    Vec3 low = {far, far, far}, high = {-far, -far, -far};
    for_drawn(vertices, faces, [&](Vec3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    });
    if (low.x > high.x)
        throw std::invalid_argument(faces.empty() ? "nothing to draw: no vertex is finite"
                                                  : "nothing to draw: no face has three finite corners");
    const Box box = {0.5 * low + 0.5 * high, high - low};
    if (!std::isfinite(box.diagonal()))
        throw std::invalid_argument("the vertices are too far apart for double precision; scale them down");
    return box;
}

}  // namespace gaussmap
