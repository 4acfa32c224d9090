// The Delaunay fans of all points of a cloud.
#include <algorithm>

#include "check.h"
#include "check_cloud.h"
#include "fan.h"
#include "frame.h"
#include "gaussmap/neighbors.h"
#include "parallel.h"

namespace gaussmap {

Fans fans(Points points, Points normals, const Neighbors& neighbors, const Execution& run) {
    check_count("normals", normals.count, points.count, "points");
    check_neighbors(neighbors.index, neighbors.k, points.count);
    constexpr std::size_t grain = 1024;
    Fans result;
    result.begin.assign(points.count + 1, 0);
    result.closed.assign(points.count, 0);
    std::vector<std::vector<std::int32_t>> chains(block_count(points.count, grain));
    for_blocks(points.count, grain, run, [&](std::size_t block, std::size_t i, std::size_t last) {
        LaneNeighborhoods around(neighbors.k);
        std::vector<Fan> fans(fit_lanes, Fan(neighbors.k));
        Vec3 normal[fit_lanes];
        for (; i < last; i += fit_lanes) {
            const std::size_t count = std::min<std::size_t>(fit_lanes, last - i);
            around.gather(points, i, count, neighbors[i], neighbors.k);
            for (std::size_t l = 0; l < count; ++l) normal[l] = unit(load(normals[i + l]));
            build_fans(around, {normal, count}, fans);
            for (std::size_t l = 0; l < count; ++l) {
                const Fan& fan = fans[l];
                const std::int32_t* const row = neighbors[i + l];
                for (std::size_t c = 0; c < fan.corners; ++c) chains[block].push_back(row[fan.chain[c]]);
                result.begin[i + l + 1] = fan.corners;
                result.closed[i + l] = fan.closed;
            }
        }
    });
    for (std::size_t i = 0; i < points.count; ++i) result.begin[i + 1] += result.begin[i];
    result.index.reserve(result.begin.back());
    for (const auto& chain : chains) result.index.insert(result.index.end(), chain.begin(), chain.end());
    return result;
}

}  // namespace gaussmap
