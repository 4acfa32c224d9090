#include "one_ring.h"

#include <cmath>
#include <limits>
#include <vector>

#include "corrected_curvature.h"

namespace gaussmap {
namespace {

/// Part of the mean square of a smooth difference that a vertex's own may deviate from the mean about it.
constexpr double least_rough = 0.05;
/// Where even the fits' remainders cancel on a grid, the changes that tell their errors come out too small: measured,
/// up to sixfold.
constexpr double understated = 36;
constexpr int reach = 8;  ///< steps of diffusion

}  // namespace

void take_one_rings(Points vertices, Triangles faces, Points unit_normals, AutomaticCurvature& found,
                    const Execution& run) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr std::uint8_t clean = 2;
    const std::size_t count = found.density.size();
    const std::vector<double> corrected = corrected_density(vertices, faces, unit_normals, run);
    // Relative to the fits: squares of densities have no place among floats.
    std::vector<float> change(count, nan), difference, error(count, nan);
    for (std::size_t i = 0; i < count; ++i)
        if (found.choice[i] == clean) change[i] = static_cast<float>((corrected[i] - found.density[i]) * found.unit);
    std::vector<float> rough = roughness(change, found.graph, run);
    difference = change;
    for (std::size_t i = 0; i < count; ++i) {
        if (found.choice[i] != clean) continue;
        difference[i] = change[i] * change[i];
        error[i] = static_cast<float>(std::pow(found.error[i] * found.unit, 2));
    }
    for (auto* field : {&rough, &difference, &error}) diffuse(*field, found.graph, reach, run);
    for (std::size_t i = 0; i < count; ++i) {
        if (found.choice[i] != clean || !std::isfinite(change[i])) continue;
        if (!(rough[i] < least_rough * difference[i] && difference[i] < understated * error[i])) continue;
        found.density[i] = corrected[i];
        found.choice[i] = one_ring_choice;
    }
}

}  // namespace gaussmap
