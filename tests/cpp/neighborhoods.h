// Neighbourhoods made for tests of fans.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "gaussmap/neighbors.h"

namespace support {

using Plane = std::array<double, 2>;

/// Many neighbourhoods in one cloud: the centre is point (k + 1) c, its neighbours follow it.
struct Neighborhoods {
    std::vector<double> points, normals;
    gaussmap::Neighbors neighbors;

    explicit Neighborhoods(std::size_t k) { neighbors.k = k; }
    void add(const std::vector<std::array<double, 3>>& offsets, std::array<double, 3> centre = {0, 0, 0},
             std::array<double, 3> normal = {0, 0, 1}) {
        const std::size_t first = points.size() / 3;
        const auto add_point = [&](double x, double y, double z) {
            points.insert(points.end(), {centre[0] + x, centre[1] + y, centre[2] + z});
            normals.insert(normals.end(), normal.begin(), normal.end());
            neighbors.index.resize(neighbors.index.size() + neighbors.k, -1);
        };
        add_point(0, 0, 0);
        for (const auto& d : offsets) add_point(d[0], d[1], d[2]);
        for (std::size_t j = 0; j < offsets.size(); ++j)
            neighbors.index[first * neighbors.k + j] = static_cast<std::int32_t>(first + 1 + j);
    }
    gaussmap::Fans fans() const { return gaussmap::fans(points, normals, neighbors); }
};

/// The chain of point i, as places in its neighbourhood (0 is the first neighbour).
inline std::vector<int> chain_of(const gaussmap::Fans& fans, std::size_t i) {
    std::vector<int> chain;
    for (auto at = fans.begin[i]; at < fans.begin[i + 1]; ++at)
        chain.push_back(fans.index[at] - static_cast<int>(i) - 1);
    return chain;
}

inline std::set<std::pair<int, int>> triangles_of(const std::vector<int>& chain, bool closed) {
    std::set<std::pair<int, int>> triangles;
    for (std::size_t j = 0; j + 1 < chain.size(); ++j) triangles.emplace(chain[j], chain[j + 1]);
    if (closed) triangles.emplace(chain.back(), chain.front());
    return triangles;
}

}  // namespace support
