#include "fitted_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "automatic.h"
#include "bounding_box.h"
#include "half_sample.h"
#include "jet_curvature.h"
#include "normal_regression.h"
#include "one_ring.h"
#include "ordered_cloud.h"
#include "parallel.h"
#include "pool.h"
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
    elements.neighbors = [&rings, rooms = std::make_shared<Pool<VertexRings::Room>>()](
                             std::size_t first, std::size_t last, int k, std::int32_t* rows) {
        std::unique_ptr<VertexRings::Room> room = rooms->take();
        for (std::size_t i = first; i < last; ++i, rows += k) rings.nearest(i, k, *room, rows);
        rooms->give_back(std::move(room));
    };
    return elements;
}

/// Of the box of the vertices of usable faces; 0 where there is none.
double diagonal(Points vertices, const VertexRings& rings) {
    BoundingBox box;
    for (std::size_t i = 0; i < vertices.count; ++i)
        if (rings.degree(i) > 0) box.include(load(vertices[i]));
    return box.diagonal();
}

/// Turn the fitted normals to the sides of the result's, and the shape operators with them.
void take_sides(FittedCurvature& found, MeshCurvature& result) {
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

/// What half of the vertices of usable faces tell of the errors.
void correct_errors(Points vertices, const VertexRings& rings, const Elements& elements, double size,
                    const Execution& run, AutomaticCurvature& found) {
    std::vector<std::int32_t> used;
    for (std::size_t v = 0; v < vertices.count; ++v)
        if (rings.degree(v) > 0) used.push_back(static_cast<std::int32_t>(v));
    const std::vector<std::int32_t> order = spatial_order_of(vertices, used, {run.threads, {}});
    const auto vertex = [&](std::size_t i) { return static_cast<std::size_t>(order[i]); };
    std::vector<std::int32_t> rank(vertices.count);
    for (std::size_t i = 0; i < order.size(); ++i) rank[vertex(i)] = static_cast<std::int32_t>(i);
    Elements ordered;
    ordered.count = order.size();
    ordered.connected = true;
    ordered.position = [&](std::size_t i) { return elements.position(vertex(i)); };
    ordered.neighbors = [&](std::size_t first, std::size_t last, int k, std::int32_t* rows) {
        for (std::size_t i = first; i < last; ++i, rows += k) {
            elements.neighbors(vertex(i), vertex(i) + 1, k, rows);
            for (int j = 0; j < k && rows[j] >= 0; ++j) rows[j] = rank[static_cast<std::size_t>(rows[j])];
        }
    };
    const auto looked = [&](std::size_t v) { return found.choice[v] == look_choice; };
    const auto density = [&](std::size_t i) {
        return looked(vertex(i)) && !found.on_grid[vertex(i)] ? found.density[vertex(i)] : nan;
    };
    const double factor = told_error_factor(ordered, size, density, {run.threads, {}});
    for (std::size_t v = 0; v < found.error.size(); ++v)
        if (looked(v)) found.error[v] *= factor;
}

FittedCurvature choose(Points vertices, Triangles faces, const VertexRings& rings, double size,
                       const MeshCurvatureOptions& options, MeshCurvature& result) {
    const Elements elements = elements_of(vertices, rings);
    AutomaticCurvature found = automatic_curvature(elements, size, options.run);
    const std::vector<double> own = result.normals;
    take_sides(found, result);
    take_one_rings(vertices, faces, rings, {result.normals.data(), vertices.count}, {own.data(), vertices.count}, found,
                   {options.run.threads, {}});
    if (options.confidence) correct_errors(vertices, rings, elements, size, options.run, found);
    return found;
}

FittedCurvature regress(const Elements& elements, int k, bool given, const MeshCurvatureOptions& options,
                        const MeshCurvature& result) {
    ElementNormals normals;
    if (given) {
        normals.normal.resize(elements.count);
        for (std::size_t i = 0; i < elements.count; ++i) normals.normal[i] = load(result.normals.data() + 3 * i);
    } else {
        normals = fit_normals(elements, k, CloudNormals::jet, options.degree, part_of(options.run, 0, 0.6));
    }
    return normal_regression(elements, k, normals, options.confidence, part_of(options.run, given ? 0 : 0.6, 1));
}

FittedCurvature fit(Points vertices, Triangles faces, bool given, const MeshCurvatureOptions& options,
                    MeshCurvature& result) {
    const VertexRings rings(vertices, faces);
    const double size = diagonal(vertices, rings);
    if (!std::isfinite(size) || !(size > 0)) return {};
    if (options.estimator == Estimator::automatic) return choose(vertices, faces, rings, size, options, result);
    const Elements elements = elements_of(vertices, rings);
    const int k = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(options.k), vertices.count - 1));
    FittedCurvature found = options.estimator == Estimator::jet
                                ? jet_curvature(elements, k, options.degree, options.confidence, options.run)
                                : regress(elements, k, given, options, result);
    take_sides(found, result);
    return found;
}

}  // namespace

void fitted_mesh(Points vertices, Triangles faces, bool given, const MeshCurvatureOptions& options,
                 MeshCurvature& result) {
    FittedCurvature found = fit(vertices, faces, given, options, result);
    result.lowered = found.lowered;
    result.density = std::move(found.density);
    result.density.resize(vertices.count, nan);
    if (options.estimator == Estimator::automatic) {
        result.choice = std::move(found.choice);
        result.choice.resize(vertices.count, 0);
    }
    if (options.confidence) {
        result.error = std::move(found.error);
        result.error.resize(vertices.count, nan);
    }
    if (!options.tensor) return;
    result.vertex_tensor = undefined_tensor(vertices.count);
    for (std::size_t i = 0; i < found.normal.size(); ++i)
        if (finite(found.normal[i]) && !std::isnan(result.density[i]))
            store(result.vertex_tensor, i, principal(found.tensor[i], 1, found.normal[i]));
}

}  // namespace gaussmap
