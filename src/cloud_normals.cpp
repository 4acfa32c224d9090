// Normals of all points of a cloud.
#include <algorithm>

#include "check_cloud.h"
#include "gaussmap/normals.h"
#include "normal_fit.h"
#include "parallel.h"

namespace gaussmap {

CloudNormalsResult cloud_normals(Points points, const Neighbors& neighbors, const CloudNormalsOptions& options) {
    check_degree(options.degree);
    check_neighbors(neighbors.index, neighbors.k, points.count);
    constexpr std::size_t grain = 1024;
    CloudNormalsResult result;
    result.normals.resize(3 * points.count);
    std::vector<std::size_t> undefined_in(block_count(points.count, grain)), lowered_in(undefined_in.size());
    for_blocks(points.count, grain, options.run, [&](std::size_t block, std::size_t i, std::size_t last) {
        LaneNeighborhoods around(neighbors.k);
        NormalFit fit(options.method, options.degree, neighbors.k);
        NormalFit::Result results[fit_lanes];
        for (; i < last; i += fit_lanes) {
            const std::size_t count = std::min<std::size_t>(fit_lanes, last - i);
            around.gather(points, i, count, neighbors[i], neighbors.k);
            fit(around, results);
            for (std::size_t j = 0; j < count; ++j) {
                if (!finite(results[j].normal)) ++undefined_in[block];
                if (results[j].lowered) ++lowered_in[block];
                store(result.normals.data() + 3 * (i + j), results[j].normal);
            }
        }
    });
    for (const std::size_t count : undefined_in) result.undefined += count;
    for (const std::size_t count : lowered_in) result.lowered += count;
    return result;
}

}  // namespace gaussmap
