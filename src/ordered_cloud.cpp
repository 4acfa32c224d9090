// Equal positions follow each other along the curve, so one look back finds the copies.
#include "ordered_cloud.h"

#include <utility>

#include "check_cloud.h"
#include "gaussmap/neighbors.h"
#include "parallel.h"
#include "vec.h"

namespace gaussmap {
namespace {

bool equal(Vec3 a, Vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// The indices of the finite points, empty where all are.
std::vector<std::int32_t> finite_points(Points points) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.count; ++i) count += finite(load(points[i])) ? 1 : 0;
    std::vector<std::int32_t> kept;
    if (count == points.count) return kept;
    kept.reserve(count);
    for (std::size_t i = 0; i < points.count; ++i)
        if (finite(load(points[i]))) kept.push_back(static_cast<std::int32_t>(i));
    return kept;
}

/// Input indices of the finite points along the curve.
std::vector<std::int32_t> order_of(Points points, const Execution& run) {
    const std::vector<std::int32_t> kept = finite_points(points);
    if (kept.empty() && (points.empty() || finite(load(points[0])))) return spatial_order(points, run);
    return spatial_order_of(points, kept, run);
}

}  // namespace

std::vector<std::int32_t> spatial_order_of(Points points, const std::vector<std::int32_t>& some, const Execution& run) {
    if (some.size() == points.count) return spatial_order(points, run);
    std::vector<double> places(3 * some.size());
    for (std::size_t i = 0; i < some.size(); ++i)
        store(places.data() + 3 * i, load(points[static_cast<std::size_t>(some[i])]));
    std::vector<std::int32_t> order = spatial_order(places, run);
    for (std::int32_t& index : order) index = some[static_cast<std::size_t>(index)];
    return order;
}

SpatialOrder distinct_order(Points points, const Execution& run) {
    check_countable(points);
    SpatialOrder result;
    result.first = order_of(points, run);
    std::vector<std::int32_t>& order = result.first;
    result.non_finite = points.count - order.size();
    std::size_t kept = 0;
    Vec3 last;
    for (const std::int32_t index : order) {
        const Vec3 p = load(points[static_cast<std::size_t>(index)]);
        if (kept > 0 && equal(p, last)) {
            result.copies.push_back({index, order[kept - 1]});
            continue;
        }
        order[kept++] = index;
        last = p;
    }
    order.resize(kept);
    return result;
}

OrderedCloud ordered_cloud(Points points, const Execution& run) {
    SpatialOrder order = distinct_order(points, part_of(run, 0, 0.6));
    OrderedCloud cloud;
    cloud.tree = neighbor_tree(points, order.first, part_of(run, 0.6, 1));
    cloud.source = renumber(cloud.tree);
    cloud.copies = std::move(order.copies);
    cloud.non_finite = order.non_finite;
    return cloud;
}

}  // namespace gaussmap
