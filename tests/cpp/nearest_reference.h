// The definition of nearest neighbours, slowly, for the tests.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "gaussmap/neighbors.h"
#include "support.h"

namespace support {

/// All points sorted by (squared distance, index) from each query, whose own index is left out where it is a point.
inline gaussmap::NearestPoints brute_force(const std::vector<double>& points, const std::vector<double>& queries, int k,
                                           bool others_only = false) {
    gaussmap::NearestPoints nearest;
    nearest.k = static_cast<std::size_t>(k);
    std::vector<std::pair<double, std::int32_t>> all;
    for (std::size_t i = 0; i < queries.size() / 3; ++i) {
        all.clear();
        for (std::size_t j = 0; j < points.size() / 3; ++j) {
            if (others_only && i == j) continue;
            const double dx = points[3 * j] - queries[3 * i], dy = points[3 * j + 1] - queries[3 * i + 1],
                         dz = points[3 * j + 2] - queries[3 * i + 2];
            all.emplace_back(dx * dx + dy * dy + dz * dz, static_cast<std::int32_t>(j));
        }
        const std::size_t wanted = std::min(all.size(), nearest.k);
        std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(wanted), all.end());
        for (std::size_t j = 0; j < nearest.k; ++j) {
            nearest.index.push_back(j < wanted ? all[j].second : -1);
            nearest.squared_distance.push_back(j < wanted ? all[j].first : std::numeric_limits<double>::infinity());
        }
    }
    return nearest;
}

inline gaussmap::NearestPoints brute_force(const std::vector<double>& points, int k) {
    return brute_force(points, points, k, true);
}

inline std::vector<double> random_points(std::size_t n, std::uint64_t seed, double size = 1) {
    Random random(seed);
    std::vector<double> points(3 * n);
    for (double& v : points) v = size * random.uniform();
    return points;
}

}  // namespace support
