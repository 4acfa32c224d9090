// Total curvature of point clouds: the Dirichlet energy of the normals over each point's Delaunay fan.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "check.h"
#include "check_cloud.h"
#include "clock.h"
#include "degenerate.h"
#include "estimators.h"
#include "fan.h"
#include "frame.h"
#include "gaussmap/curvature.h"
#include "parallel.h"
#include "shape_operator.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1024;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Energy {
    double kappa = 0, area = 0;
};

/// Of the triangle (0, a, b) with unit normals at its corners, eq. (3) of docs/method.md:
/// kappa = ½ Σ cot(α) |dn|² over the edges, cot(α) = (product of the edges that meet in α) / (2 area).
Energy triangle_energy(Vec3 a, Vec3 b, Vec3 normal, Vec3 normal_a, Vec3 normal_b) {
    const double at_point = dot(a, b), at_a = dot(a, a - b), at_b = dot(b, b - a);
    const double sum =
        at_point * squared(normal_b - normal_a) + at_a * squared(normal_b - normal) + at_b * squared(normal_a - normal);
    const double cross_squared = squared(cross(a, b));
    if (!std::isfinite(sum) || no_area(cross_squared, at_point + at_a + at_b)) return {};
    const double twice_area = std::sqrt(cross_squared);
    // Never negative; rounding could make it so by its last bit.
    return {std::max(sum, 0.0) / (2 * twice_area), twice_area / 2};
}

/// Over the fan of a point, in units of the scaled neighbourhood. With `align`, normals that look away from the
/// centre's are turned round.
Energy fan_energy(const Neighborhood& neighborhood, const Fan& fan, const double* normals, Vec3 normal, bool align) {
    const auto normal_of = [&](const Ray& ray) {
        const Vec3 other = load(normals + 3 * static_cast<std::size_t>(ray.index));
        return align && dot(other, normal) < 0 ? -other : other;
    };
    Energy sum;
    if (fan.chain.empty()) return sum;
    const std::size_t corners = fan.chain.size();
    const Ray* before = &fan.chain[fan.closed ? corners - 1 : 0];
    Vec3 normal_before = normal_of(*before);
    for (std::size_t c = fan.closed ? 0 : 1; c < corners; ++c) {
        const Ray* ray = &fan.chain[c];
        const Vec3 normal_here = normal_of(*ray);
        const Energy energy = triangle_energy(neighborhood.offset[before->slot], neighborhood.offset[ray->slot], normal,
                                              normal_before, normal_here);
        sum.kappa += energy.kappa;
        sum.area += energy.area;
        before = ray;
        normal_before = normal_here;
    }
    return sum;
}

/// Unit normals of the distinct points: the given ones of their first holders.
std::vector<double> given_normals(Points normals, const DistinctPoints& cloud, const Execution& run) {
    std::vector<double> result(3 * cloud.source.size());
    for_blocks(cloud.source.size(), grain, run, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i)
            store(result.data() + 3 * i, unit(load(normals[static_cast<std::size_t>(cloud.source[i])])));
    });
    return result;
}

/// Fans and densities of the distinct points, written to the places of their first holders.
void measure(const DistinctPoints& cloud, const Neighbors& neighbors, const std::vector<double>& normals, bool align,
             const Execution& run, CloudCurvature& result) {
    const std::size_t count = cloud.source.size();
    std::vector<std::size_t> boundary_in(block_count(count, grain));
    for_blocks(count, grain, run, [&](std::size_t block, std::size_t i, std::size_t last) {
        Neighborhood neighborhood(neighbors.k);
        Fan fan;
        for (; i < last; ++i) {
            const Vec3 normal = load(normals.data() + 3 * i);
            const auto place = static_cast<std::size_t>(cloud.source[i]);
            store(result.normals.data() + 3 * place, normal);
            neighborhood.gather(cloud.points, i, neighbors[i]);
            // Looking up, whichever way the normal looks: a flip of all normals changes no bit of the sums.
            build_fan(neighborhood, upward(normal), fan);
            if (fan.triangles() > 0 && !fan.closed) ++boundary_in[block];
            const Energy energy = fan_energy(neighborhood, fan, normals.data(), normal, align);
            if (!(energy.area > 0)) continue;
            if (!result.tensor.k1.empty())
                store(result.tensor, place, fan_tensor(neighborhood, fan, normals.data(), normal, align));
            result.kappa[place] = energy.kappa;
            result.density[place] = energy.kappa / energy.area * neighborhood.scale * neighborhood.scale;
        }
    });
    for (const std::size_t open : boundary_in) result.boundary += open;
}

/// Copies of a point get what its first holder got.
void share_with_copies(const DistinctPoints& cloud, CloudCurvature& result) {
    for (std::size_t i = 0; i < cloud.target.size(); ++i) {
        if (cloud.target[i] < 0) continue;
        const auto first = static_cast<std::size_t>(cloud.source[static_cast<std::size_t>(cloud.target[i])]);
        if (first == i) continue;
        result.density[i] = result.density[first];
        result.kappa[i] = result.kappa[first];
        if (!result.tensor.k1.empty()) copy(result.tensor, first, i);
        store(result.normals.data() + 3 * i, load(result.normals.data() + 3 * first));
    }
}

}  // namespace

CloudCurvature cloud_curvature(Points points, Points normals, const CloudCurvatureOptions& options) {
    check_estimator(options.estimator, Input::cloud, options.confidence);
    if (options.k < 3)
        throw std::invalid_argument("k = " + std::to_string(options.k) +
                                    " is too small; a fan takes at least 3 neighbours");
    check_degree(options.degree);
    if (!normals.empty()) check_count("normals", normals.count, points.count, "points");

    CloudCurvature result;
    auto start = Clock::now();
    const DistinctPoints cloud = distinct_points(points);
    result.duplicates = cloud.duplicates;
    result.non_finite = cloud.non_finite;
    const auto others = static_cast<int>(std::max<std::size_t>(cloud.source.size(), 2) - 1);
    const Neighbors neighbors =
        nearest_neighbors(cloud.points, std::min(options.k, others), part_of(options.run, 0, 0.4));
    result.seconds_neighbors = seconds_since(start);

    start = Clock::now();
    const bool estimate = normals.empty();
    std::vector<double> unit_normals;
    if (estimate) {
        CloudNormalsResult fitted =
            cloud_normals(cloud.points, neighbors, {options.method, options.degree, part_of(options.run, 0.4, 0.7)});
        result.lowered = fitted.lowered;
        unit_normals = std::move(fitted.normals);
        if (options.orientation == Orientation::mst)
            orient_normals(cloud.points, neighbors, unit_normals, part_of(options.run, 0.7, 0.8));
    } else {
        unit_normals = given_normals(normals, cloud, part_of(options.run, 0.4, 0.5));
    }
    result.seconds_normals = seconds_since(start);

    start = Clock::now();
    result.density.assign(points.count, nan);
    result.kappa.assign(points.count, nan);
    result.normals.assign(3 * points.count, nan);
    if (options.tensor) result.tensor = undefined_tensor(points.count);
    const bool align = estimate && options.orientation == Orientation::local;
    measure(cloud, neighbors, unit_normals, align, part_of(options.run, 0.8, 1), result);
    share_with_copies(cloud, result);
    for (const double density : result.density) result.undefined += std::isnan(density) ? 1 : 0;
    result.seconds_curvature = seconds_since(start);
    return result;
}

}  // namespace gaussmap
