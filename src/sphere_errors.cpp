// Three errors. Noise moves a point along the surface, too, and its density is then one of another place: by the noise
// times the density's gradient, whatever is measured there. What noise is left in a density is less than of the best
// that was mixed, as several scales of spheres are about as good. And the bias: what the next rung changes tells too
// much of it on little noise and too little on much, more so beside borders. So the part of it that counts is the
// larger the more the candidates that were mixed disagree for the density, the wider the window, and the more a border
// cuts it.
#include "sphere_errors.h"

#include <algorithm>
#include <cmath>

#include "element_graph.h"
#include "scale_ladder.h"

namespace gaussmap {
namespace {

/// Variance by noise of what is mixed, relative to that of the best.
constexpr double of_mixed = 0.4;
/// Squared bias relative to what it is found to go with: among others a power of the neighbours in the window, between
/// their number, as its area goes, and the root, as its radius.
constexpr double bias_part = 0.045, bias_part_extrapolated = 0.3, power_of_neighbors = 0.75;
/// Borders that cut a window more do not change it more.
constexpr float most_cut = 4;

/// Squared gradients of the density along the surface.
std::vector<float> squared_gradients(const Level& level, const std::vector<double>& density) {
    std::vector<float> gradient(level.count(), 0);
    for (std::size_t i = 0; i < level.count(); ++i) {
        double changes = 0, distances = 0;
        for (std::size_t j = 0; j < ElementGraph::degree && level.graph[i][j] >= 0; ++j) {
            const auto other = static_cast<std::size_t>(level.graph[i][j]);
            const double change = density[other] - density[i];
            if (!std::isfinite(change)) continue;
            changes += change * change;
            distances += squared(level.foot_of(other) - level.foot_of(i));
        }
        // Of all directions the gradient's has twice the mean square.
        if (distances > 0) gradient[i] = static_cast<float>(2 * changes / distances);
    }
    return gradient;
}

}  // namespace

void tell_sphere_errors(const Level& lowest, const std::vector<float>& noise, Measured& measured,
                        const Execution& run) {
    std::vector<float> gradient = squared_gradients(lowest, measured.density), disagreement = measured.disagreement,
                       cut = measured.cut;
    for (float& c : cut) c = c > 1 ? std::min(c, most_cut) : 1;  // 1 too where slopes told nothing
    diffuse({&gradient, &disagreement, &cut}, lowest.graph, near_reach, run);
    for (std::size_t i = 0; i < measured.density.size(); ++i) {
        const std::uint8_t choice = measured.choice[i];
        if (choice < first_rung_choice || !of_spheres(family_of(choice))) continue;
        const double density = measured.density[i], by_noise = measured.noise[i], apart = disagreement[i],
                     told = std::max(0.0, measured.error[i] - by_noise);
        const double moved =
            std::isfinite(noise[i]) ? static_cast<double>(noise[i]) * static_cast<double>(gradient[i]) : 0;
        const double relative = apart > 0 ? std::sqrt(apart / (density * density + apart)) : 0;
        const double part = family_of(choice) == Family::extrapolated ? bias_part_extrapolated : bias_part;
        const double bias = part * std::pow(rung_neighbors(rung_of(choice)), power_of_neighbors) * told * relative *
                            std::sqrt(static_cast<double>(cut[i]));
        measured.error[i] = static_cast<float>(of_mixed * by_noise + moved + bias);
    }
}

}  // namespace gaussmap
