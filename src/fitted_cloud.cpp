#include "fitted_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "automatic.h"
#include "bounding_box.h"
#include "clock.h"
#include "half_sample.h"
#include "jet_curvature.h"
#include "neighbor_rows.h"
#include "normal_regression.h"
#include "ordered_cloud.h"
#include "parallel.h"
#include "shape_operator.h"
#include "shape_tensor.h"

namespace gaussmap {
namespace {

Elements elements_of(const OrderedCloud& cloud) {
    static_assert(Elements::block % leaf_points == 0);
    Elements elements;
    elements.count = cloud.count();
    elements.position = [&cloud](std::size_t i) { return cloud[i]; };
    elements.neighbors = [&cloud](std::size_t first, std::size_t last, int k, std::int32_t* rows) {
        const auto stride = static_cast<std::size_t>(k);
        const std::size_t others = std::min(stride, cloud.count() - 1);
        if (others < stride) std::fill(rows, rows + (last - first) * stride, -1);
        if (others == 0) return;
        NeighborRows search(cloud.tree, others);
        for (std::size_t i = first; i < last; i += leaf_points) search.find(i / leaf_points, rows, stride, first);
    };
    return elements;
}

double diagonal(const OrderedCloud& cloud) {
    BoundingBox box;
    for (std::size_t i = 0; i < cloud.count(); ++i) box.include(cloud[i]);
    return box.diagonal();
}

/// Element i's values, to a place of the result.
void place(const FittedCurvature& found, std::size_t i, Points normals, std::size_t to,
           const CloudCurvatureOptions& options, CloudCurvature& result) {
    Vec3 normal = found.normal[i];
    double sign = 1;
    // Looking as the given normal does; a fitted normal says nothing of the side, so up.
    Vec3 side = upward(normal);
    if (!normals.empty() && finite(unit(load(normals[to])))) side = load(normals[to]);
    if (dot(normal, side) < 0) normal = -normal, sign = -1;
    result.density[to] = found.density[i];
    if (!found.choice.empty()) result.choice[to] = found.choice[i];
    store(result.normals.data() + 3 * to, normal);
    if (options.confidence) result.error[to] = found.error[i];
    if (options.tensor && finite(normal)) store(result.tensor, to, principal(found.tensor[i], sign, normal));
}

/// What half of the points tell of the errors.
/// \param on_grid  of each of the cloud's points.
void correct_errors(const OrderedCloud& cloud, double size, const std::vector<std::uint8_t>& on_grid,
                    const Execution& run, CloudCurvature& result) {
    const auto place_of = [&](std::size_t i) { return static_cast<std::size_t>(cloud.source[i]); };
    const auto looked = [&](std::size_t to) { return result.choice[to] == look_choice; };
    const auto density = [&](std::size_t i) {
        return looked(place_of(i)) && !on_grid[i] ? result.density[place_of(i)]
                                                  : std::numeric_limits<double>::quiet_NaN();
    };
    const double factor = told_error_factor(elements_of(cloud), size, density, run);
    for (std::size_t to = 0; to < result.error.size(); ++to)
        if (looked(to)) result.error[to] *= factor;
}

/// Unit normals of the first holders of positions.
ElementNormals given_normals(const OrderedCloud& cloud, Points normals) {
    ElementNormals given;
    given.normal.resize(cloud.count());
    for (std::size_t i = 0; i < cloud.count(); ++i)
        given.normal[i] = unit(load(normals[static_cast<std::size_t>(cloud.source[i])]));
    return given;
}

/// By any estimator but the automatic one.
FittedCurvature fit(const OrderedCloud& cloud, Points normals, const CloudCurvatureOptions& options,
                    const Execution& run, CloudCurvature& result) {
    const Elements elements = elements_of(cloud);
    if (options.estimator == Estimator::jet)
        return jet_curvature(elements, options.k, options.degree, options.confidence, run);
    Lap lap;
    const ElementNormals known =
        normals.empty() ? fit_normals(elements, options.k, options.method, options.degree, part_of(run, 0, 0.6))
                        : given_normals(cloud, normals);
    lap.add_to(result.seconds_normals);
    return normal_regression(elements, options.k, known, options.confidence,
                             part_of(run, normals.empty() ? 0.6 : 0, 1));
}

}  // namespace

CloudCurvature fitted_cloud(Points points, Points normals, const CloudCurvatureOptions& options) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    CloudCurvature result;
    Lap lap;
    const OrderedCloud cloud = ordered_cloud(points, part_of(options.run, 0, 0.05));
    result.duplicates = cloud.copies.size();
    result.non_finite = cloud.non_finite;
    lap.add_to(result.seconds_neighbors);

    result.density.assign(points.count, nan);
    result.kappa.assign(points.count, nan);
    result.normals.assign(3 * points.count, nan);
    if (options.estimator == Estimator::automatic) result.choice.assign(points.count, 0);
    if (options.confidence) result.error.assign(points.count, nan);
    if (options.tensor) result.tensor = undefined_tensor(points.count);
    if (const double size = diagonal(cloud); std::isfinite(size) && size > 0) {
        const Execution run = part_of(options.run, 0.05, 1);
        const auto take = [&](const FittedCurvature& found, std::size_t i, std::size_t element) {
            place(found, i, normals, static_cast<std::size_t>(cloud.source[element]), options, result);
        };
        if (options.estimator == Estimator::automatic) {
            std::vector<std::uint8_t> on_grid(options.confidence ? cloud.count() : 0);
            const auto take_all = [&](const AutomaticCurvature& found, std::size_t i, std::size_t element) {
                take(found, i, element);
                if (options.confidence) on_grid[element] = found.on_grid[i];
            };
            result.lowered = automatic_curvature(elements_of(cloud), size, take_all, run);
            if (options.confidence) correct_errors(cloud, size, on_grid, run, result);
        } else {
            const FittedCurvature found = fit(cloud, normals, options, run, result);
            for (std::size_t i = 0; i < cloud.count(); ++i) take(found, i, i);
            result.lowered = found.lowered;
        }
    }
    for (const auto& [index, first] : cloud.copies) {
        const auto to = static_cast<std::size_t>(index), from = static_cast<std::size_t>(first);
        result.density[to] = result.density[from];
        if (!result.choice.empty()) result.choice[to] = result.choice[from];
        store(result.normals.data() + 3 * to, load(result.normals.data() + 3 * from));
        if (options.confidence) result.error[to] = result.error[from];
        if (options.tensor) copy(result.tensor, from, to);
    }
    for (const double density : result.density) result.undefined += std::isnan(density) ? 1 : 0;
    lap.add_to(result.seconds_curvature);
    result.seconds_curvature -= result.seconds_normals;
    return result;
}

}  // namespace gaussmap
