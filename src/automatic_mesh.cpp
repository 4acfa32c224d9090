#include "automatic_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "automatic.h"
#include "one_ring.h"
#include "parallel.h"
#include "shape_operator.h"
#include "shape_tensor.h"
#include "vertex_rings.h"

namespace gaussmap {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Vertices of no usable face are elements without neighbours, and so undefined.
Elements elements_of(Points vertices, const VertexRings& rings) {
    Elements elements;
    elements.count = vertices.count;
    elements.connected = true;
    elements.position = [vertices](std::size_t i) { return load(vertices[i]); };
    elements.neighbors = [&rings](std::size_t first, std::size_t last, int k, std::int32_t* rows) {
        VertexRings::Room room;
        for (std::size_t i = first; i < last; ++i, rows += k) rings.nearest(i, k, room, rows);
    };
    return elements;
}

/// Diagonal of the box of the vertices of usable faces; 0 where there is none.
double diagonal(Points vertices, const VertexRings& rings) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low = {infinity, infinity, infinity}, high = -low;
    bool any = false;
    for (std::size_t i = 0; i < vertices.count; ++i) {
        if (rings.degree(i) == 0) continue;
        any = true;
        const Vec3 p = load(vertices[i]);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return any ? length(high - low) : 0;
}

/// Turn the fitted normals to the sides of the result's, and the shape operators with them.
void take_sides(AutomaticCurvature& found, MeshCurvature& result) {
    for (std::size_t i = 0; i < found.normal.size(); ++i) {
        Vec3& normal = found.normal[i];
        if (!finite(normal)) continue;
        if (dot(normal, load(result.normals.data() + 3 * i)) < 0) {
            Symmetric3 turned;
            add(turned, -1, found.tensor[i]);
            found.tensor[i] = turned;
            normal = -normal;
        }
        store(result.normals.data() + 3 * i, normal);
    }
}

}  // namespace

void automatic_mesh(Points vertices, Triangles faces, const MeshCurvatureOptions& options, MeshCurvature& result) {
    const VertexRings rings(vertices, faces);
    const std::size_t count = vertices.count;
    AutomaticCurvature found;
    if (const double size = diagonal(vertices, rings); std::isfinite(size) && size > 0)
        found = automatic_curvature(elements_of(vertices, rings), size, options.run);
    take_sides(found, result);
    if (!found.density.empty())
        take_one_rings(vertices, faces, {result.normals.data(), count}, found, {options.run.threads, {}});
    result.density = std::move(found.density);
    result.density.resize(count, nan);
    result.choice = std::move(found.choice);
    result.choice.resize(count, 0);
    if (options.confidence) {
        result.error = std::move(found.error);
        result.error.resize(count, nan);
    }
    if (!options.tensor) return;
    result.vertex_tensor = undefined_tensor(count);
    for (std::size_t i = 0; i < found.normal.size(); ++i)
        if (finite(found.normal[i])) store(result.vertex_tensor, i, principal(found.tensor[i], 1, found.normal[i]));
}

}  // namespace gaussmap
