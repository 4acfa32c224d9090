// A cloud without repetitions, in input order.
#include <utility>

#include "gaussmap/neighbors.h"
#include "ordered_cloud.h"

namespace gaussmap {

DistinctPoints distinct_points(Points points) {
    DistinctPoints distinct;
    {
        SpatialOrder order = distinct_order(points, {1, {}});
        distinct.duplicates = order.copies.size();
        distinct.non_finite = order.non_finite;
        // A point's first holder, for now; itself where it is one.
        distinct.target.assign(points.count, -1);
        for (const std::int32_t i : order.first) distinct.target[static_cast<std::size_t>(i)] = i;
        for (const Copy& copy : order.copies) distinct.target[static_cast<std::size_t>(copy.index)] = copy.first;
        distinct.source = std::move(order.first);
    }
    distinct.points.reserve(3 * distinct.source.size());
    distinct.source.clear();
    for (std::size_t i = 0; i < points.count; ++i) {
        const std::int32_t first = distinct.target[i];
        if (first < 0) continue;
        if (static_cast<std::size_t>(first) < i) {
            distinct.target[i] = distinct.target[static_cast<std::size_t>(first)];
            continue;
        }
        distinct.target[i] = static_cast<std::int32_t>(distinct.source.size());
        distinct.source.push_back(first);
        distinct.points.insert(distinct.points.end(), points[i], points[i] + 3);
    }
    return distinct;
}

}  // namespace gaussmap
