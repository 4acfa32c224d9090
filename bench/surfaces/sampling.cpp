#include "sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <queue>
#include <unordered_map>
#include <utility>

namespace {

/// `count` different candidates, each with a chance in proportion to its area: those with the smallest of the
/// exponentially distributed times −log(u) / area (Efraimidis, Spirakis 2006).
std::vector<std::size_t> drawn_by_area(const std::vector<double>& area, std::size_t count, Dice& dice) {
    std::vector<std::pair<double, std::size_t>> times;
    for (std::size_t i = 0; i < area.size(); ++i) times.emplace_back(-std::log(1 - dice.uniform()) / area[i], i);
    count = std::min(count, times.size());
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(count) - 1, times.end());
    std::vector<std::size_t> drawn;
    for (std::size_t i = 0; i < count; ++i) drawn.push_back(times[i].second);
    return drawn;
}

/// Pairs nearer than `reach`, through a hash of cubes of that side.
struct Near {
    std::vector<std::vector<std::pair<std::uint32_t, float>>> of;  ///< neighbour and weight

    Near(const std::vector<double>& points, double reach) : of(points.size() / 3) {
        const auto cell = [&](std::size_t i, int c) {
            return static_cast<std::int64_t>(std::floor(points[3 * i + c] / reach));
        };
        const auto key = [](std::int64_t x, std::int64_t y, std::int64_t z) {
            return (x + (1 << 20)) << 42 | (y + (1 << 20)) << 21 | (z + (1 << 20));
        };
        std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cubes;
        for (std::size_t i = 0; i < of.size(); ++i)
            cubes[key(cell(i, 0), cell(i, 1), cell(i, 2))].push_back(static_cast<std::uint32_t>(i));
        for (std::size_t i = 0; i < of.size(); ++i)
            for (int d = 0; d < 27; ++d) {
                const auto cube =
                    cubes.find(key(cell(i, 0) + d % 3 - 1, cell(i, 1) + d / 3 % 3 - 1, cell(i, 2) + d / 9 - 1));
                if (cube == cubes.end()) continue;
                for (const std::uint32_t j : cube->second) {
                    const double* a = &points[3 * i];
                    const double* b = &points[3 * std::size_t{j}];
                    const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
                    if (j != i && distance < reach)
                        of[i].emplace_back(j, static_cast<float>(std::pow(1 - distance / reach, 8)));
                }
            }
    }
};

}  // namespace

double Dice::normal() {
    for (;;) {
        const double x = 2 * uniform() - 1, y = 2 * uniform() - 1, s = x * x + y * y;
        if (s > 0 && s < 1) return x * std::sqrt(-2 * std::log(s) / s);
    }
}

std::vector<std::size_t> poisson_disk(const Candidates& candidates, std::size_t count, Dice& dice) {
    std::vector<std::size_t> alive = drawn_by_area(candidates.area, 5 * count, dice);
    std::vector<double> points;
    for (const std::size_t i : alive)
        for (int c = 0; c < 3; ++c) points.push_back(candidates.surface.vertices[3 * i + c]);
    const double area = std::accumulate(candidates.area.begin(), candidates.area.end(), 0.0);
    // Twice the radius of the densest packing of `count` disks.
    const Near near(points, 2 * std::sqrt(area / (2 * std::numbers::sqrt3 * static_cast<double>(count))));

    std::vector<double> weight(alive.size());
    std::priority_queue<std::pair<double, std::size_t>> heaviest;
    for (std::size_t i = 0; i < alive.size(); ++i) {
        for (const auto& [j, w] : near.of[i]) weight[i] += w;
        heaviest.emplace(weight[i], i);
    }
    std::vector<char> gone(alive.size());
    for (std::size_t left = alive.size(); left > count;) {
        const auto [heavy, i] = heaviest.top();
        heaviest.pop();
        if (gone[i] || heavy != weight[i]) continue;  // an entry that was overtaken
        gone[i] = 1, --left;
        for (const auto& [j, w] : near.of[i])
            if (!gone[j]) heaviest.emplace(weight[j] -= w, j);
    }
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < alive.size(); ++i)
        if (!gone[i]) kept.push_back(alive[i]);
    dice.shuffle(kept);
    return kept;
}
