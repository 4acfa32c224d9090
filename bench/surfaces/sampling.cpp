#include "sampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "gaussmap/sampling.h"

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

}  // namespace

double Dice::normal() {
    for (;;) {
        const double x = 2 * uniform() - 1, y = 2 * uniform() - 1, s = x * x + y * y;
        if (s > 0 && s < 1) return x * std::sqrt(-2 * std::log(s) / s);
    }
}

std::vector<std::size_t> poisson_disk(const Candidates& candidates, std::size_t count, Dice& dice) {
    const std::vector<std::size_t> drawn = drawn_by_area(candidates.area, 5 * count, dice);
    std::vector<double> points;
    for (const std::size_t i : drawn)
        for (int c = 0; c < 3; ++c) points.push_back(candidates.surface.vertices[3 * i + c]);
    const double area = std::accumulate(candidates.area.begin(), candidates.area.end(), 0.0);
    std::vector<std::size_t> kept;
    for (const std::int32_t i : gaussmap::poisson_subset(points, area, count))
        kept.push_back(drawn[static_cast<std::size_t>(i)]);
    dice.shuffle(kept);
    return kept;
}
