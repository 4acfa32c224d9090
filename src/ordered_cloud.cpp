// Equal positions follow each other along the curve, so one look back finds the copies.
#include "ordered_cloud.h"

#include "check_cloud.h"
#include "gaussmap/neighbors.h"
#include "parallel.h"
#include "vec.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1 << 16;

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
    std::vector<double> some(3 * kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i)
        store(some.data() + 3 * i, load(points[static_cast<std::size_t>(kept[i])]));
    std::vector<std::int32_t> order = spatial_order(some, run);
    for (std::int32_t& index : order) index = kept[static_cast<std::size_t>(index)];
    return order;
}

}  // namespace

OrderedCloud ordered_cloud(Points points, const Execution& run) {
    check_countable(points);
    OrderedCloud cloud;
    cloud.source = order_of(points, part_of(run, 0, 0.7));
    std::vector<std::int32_t>& source = cloud.source;
    cloud.non_finite = points.count - source.size();
    cloud.points.resize(3 * source.size());
    for_blocks(source.size(), grain, part_of(run, 0.7, 1), [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) store(cloud.points.data() + 3 * i, load(points[static_cast<std::size_t>(source[i])]));
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < source.size(); ++i) {
        const Vec3 p = load(cloud.points.data() + 3 * i);
        if (kept > 0 && equal(p, load(cloud.points.data() + 3 * (kept - 1)))) {
            cloud.copies.push_back({source[i], source[kept - 1]});
            continue;
        }
        store(cloud.points.data() + 3 * kept, p);
        source[kept++] = source[i];
    }
    source.resize(kept);
    cloud.points.resize(3 * kept);
    return cloud;
}

}  // namespace gaussmap
