// Twicing: a window that made K D of a density D makes K K D of K D, and so takes about as much away once more. Known
// are K D and, by averages over as much of the surface as the window's second derivatives come from, K K D. Stuetzle
// and Mittal, "Some comments on the asymptotic behavior of robust smoothers", 1979, corrects by the difference; here it
// would bring back more noise than it mends, but tells how much is missing where all rungs smooth alike.
#include "window_bias.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scale_ladder.h"

namespace gaussmap {
namespace {

/// Neighbours in the window for one average over ten: t averages reach as far as a window of 15 t, which second
/// derivatives of quadrics see to half of its radius. Those of quartics follow a density that varies by squares, as the
/// window 1 − (1 − K)² does, K being half as wide.
constexpr int of_quadrics = 60, of_quartics = 120;
/// What is missing, squared, relative to what goes at second sight.
constexpr float missing_of_quadrics = 5, missing_of_quartics = 5.4F;
/// Noise that is left in a density goes at second sight, too, and would pass for this times its variance.
constexpr float missing_of_noise = 4;

/// So many at least, which is more than small windows take: the neighbours of an element do not lie evenly about it,
/// and that is most of what a few averages change. How much more, by the squares of lengths, `share` tells.
constexpr int fewest = 4;
int averages(int rung, int neighbors) {
    return std::max(fewest, rung_neighbors(rung) / neighbors);
}
float share(int rung, int neighbors) {
    return static_cast<float>(rung_neighbors(rung)) / static_cast<float>(neighbors * averages(rung, neighbors));
}

}  // namespace

void add_window_bias(const ElementGraph& graph, Measured& measured, const Execution& run) {
    const std::size_t count = measured.density.size();
    const auto quartic = [&](std::size_t i) { return family_of(measured.choice[i]) == Family::quartic; };
    const auto neighbors = [&](std::size_t i) { return quartic(i) ? of_quartics : of_quadrics; };
    // The densities averaged once by an element's window, and twice for quartics.
    std::vector<float> smooth(measured.density.begin(), measured.density.end()), once(smooth), twice(smooth);
    std::vector<int> wanted(count, 0);
    int last = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const int rung = rung_of(measured.choice[i]);
        if (rung < 0 || of_spheres(family_of(measured.choice[i]))) continue;
        wanted[i] = averages(rung, neighbors(i));
        last = std::max(last, (quartic(i) ? 2 : 1) * wanted[i]);
    }
    for (int step = 1; step <= last; ++step) {
        diffuse(smooth, graph, 1, run);
        for (std::size_t i = 0; i < count; ++i) {
            if (step == wanted[i]) once[i] = smooth[i];
            if (step == 2 * wanted[i]) twice[i] = smooth[i];
        }
    }
    // Of those alone that have one.
    std::vector<float> bias(count, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < count; ++i) {
        if (wanted[i] == 0) continue;
        const auto density = static_cast<float>(measured.density[i]);
        const float part = share(rung_of(measured.choice[i]), neighbors(i));
        bias[i] = quartic(i)
                      ? missing_of_quartics * std::pow(part, 4.0F) * std::pow(density - 2 * once[i] + twice[i], 2.0F)
                      : missing_of_quadrics * std::pow(part * (density - once[i]), 2.0F);
    }
    // As differences pass through zero.
    diffuse(bias, graph, near_reach, run);
    for (std::size_t i = 0; i < count; ++i) {
        if (wanted[i] == 0 || !std::isfinite(bias[i])) continue;
        measured.error[i] += std::max(0.0F, bias[i] - missing_of_noise * measured.noise[i]);
    }
}

}  // namespace gaussmap
