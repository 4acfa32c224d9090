#include "disc_radii.h"

#include <algorithm>

#include "gaussmap/neighbors.h"
#include "parallel.h"
#include "percentile.h"
#include "vec.h"

namespace gaussmap {

std::vector<double> disc_radii(Points points, const Execution& run) {
    const DistinctPoints distinct = distinct_points(points);
    const std::size_t n = distinct.source.size();
    constexpr int k = 6;
    const Neighbors neighbors = nearest_neighbors(distinct.points, k, run);
    std::vector<double> reach(n, 0), radii(points.count, 0);
    for_blocks(n, 1 << 15, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (int j = 0; j < k && neighbors[i][j] >= 0; ++j)
                reach[i] = length(load(&distinct.points[3 * static_cast<std::size_t>(neighbors[i][j])]) -
                                  load(&distinct.points[3 * i]));
    });
    std::vector<double> sorted = reach;
    const double median = percentile(sorted, 0.5);
    for (std::size_t i = 0; i < n; ++i)
        radii[static_cast<std::size_t>(distinct.source[i])] =
            n == 1 ? 1 : 0.7 * std::clamp(reach[i], 0.3 * median, 3 * median);
    return radii;
}

}  // namespace gaussmap
