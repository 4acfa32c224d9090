#include "one_ring.h"

#include <cmath>
#include <limits>
#include <vector>

#include "corrected_curvature.h"

namespace gaussmap {
namespace {

/// Part of the mean square of a smooth difference that a vertex's own may deviate from the mean about it.
constexpr double least_rough = 0.05;
/// The measures' error is for the most part that of an average over the one-ring. An average over the ring's vertices
/// changes them by 1.8 times as much (second moments of hexagons and of their corners; measured on grids: 1.7 to 1.9).
/// Fits that differ by more than 1.5 times that error, squared, are the culprits.
constexpr double excess = 0.7;
constexpr int reach = 8;  ///< steps of diffusion

/// Over the vertices of the one-ring.
double mean_around(std::size_t vertex, const std::vector<double>& field, const VertexRings& rings) {
    double sum = 0;
    int terms = 0;
    for (const std::int32_t v : rings.around(vertex)) {
        const double value = field[static_cast<std::size_t>(v)];
        if (std::isfinite(value)) sum += value, ++terms;
    }
    return sum / terms;
}

}  // namespace

void take_one_rings(Points vertices, Triangles faces, const VertexRings& rings, Points unit_normals,
                    AutomaticCurvature& found, const Execution& run) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr std::uint8_t clean = 2;
    const std::size_t count = found.density.size();
    const std::vector<double> corrected = corrected_density(vertices, faces, unit_normals, run);
    // Relative to the fits: squares of densities have no place among floats.
    std::vector<float> change(count, nan), difference(count, nan), blur(count, nan);
    for (std::size_t i = 0; i < count; ++i) {
        if (found.choice[i] != clean) continue;
        change[i] = static_cast<float>((corrected[i] - found.density[i]) * found.unit);
        difference[i] = change[i] * change[i];
        blur[i] = static_cast<float>(std::pow((mean_around(i, corrected, rings) - corrected[i]) * found.unit, 2));
    }
    std::vector<float> rough = roughness(change, found.graph, run);
    for (auto* field : {&rough, &difference, &blur}) diffuse(*field, found.graph, reach, run);
    for (std::size_t i = 0; i < count; ++i) {
        if (found.choice[i] != clean || !std::isfinite(change[i])) continue;
        if (!(rough[i] < least_rough * difference[i] && difference[i] > excess * blur[i])) continue;
        found.density[i] = corrected[i];
        found.choice[i] = one_ring_choice;
    }
}

}  // namespace gaussmap
