#include "one_ring.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "corrected_curvature.h"
#include "first_look.h"

namespace gaussmap {
namespace {

/// The measures' error is for the most part that of an average over the one-ring. An average over the ring's vertices
/// changes them by 1.8 times as much (second moments of hexagons and of their corners; measured on grids: 1.7 to 1.9).
/// Fits that differ by more than 1.5 times that error, squared, are the culprits; unless the difference is rough, as it
/// is on irregular meshes (the mean square deviation from the mean nearby is 0.7 of the mean square and more), where it
/// is the measures that err.
constexpr double of_blur = 0.7, of_rough = 3;
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

/// Whether the one-ring is closed, and those of its vertices: on borders the measures are one-sided, and err with the
/// edge's length rather than with its square, and so do the normals of meshes.
bool inside(std::size_t vertex, const VertexRings& rings) {
    const auto around = rings.around(vertex);
    return !rings.open(vertex) && std::none_of(around.begin(), around.end(),
                                               [&](std::int32_t v) { return rings.open(static_cast<std::size_t>(v)); });
}

}  // namespace

void take_one_rings(Points vertices, Triangles faces, const VertexRings& rings, Points fitted_normals,
                    Points mesh_normals, AutomaticCurvature& found, const Execution& run) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr std::uint8_t lowered = 1, clean = 2;
    const std::size_t count = found.density.size();
    const std::vector<double> corrected = corrected_density(vertices, faces, fitted_normals, run);
    // Relative to the fits: squares of densities have no place among floats.
    std::vector<float> change(count, nan), difference(count, nan), blur(count, nan);
    for (std::size_t i = 0; i < count; ++i) {
        if (found.choice[i] != clean || !inside(i, rings)) continue;
        change[i] = static_cast<float>((corrected[i] - found.density[i]) * found.unit);
        difference[i] = change[i] * change[i];
        blur[i] = static_cast<float>(std::pow((mean_around(i, corrected, rings) - corrected[i]) * found.unit, 2));
    }
    std::vector<float> rough = roughness(change, found.graph, run);
    for (auto* field : {&rough, &difference, &blur}) diffuse(*field, found.graph, reach, run);
    const bool enough = count > wide_neighbors;
    const std::vector<double> own = corrected_density(vertices, faces, mesh_normals, run);
    for (std::size_t i = 0; i < count; ++i) {
        if (found.choice[i] != clean && found.choice[i] != lowered) continue;
        if (!std::isfinite(own[i]) || !inside(i, rings)) continue;
        // Where many neighbours lie on too few lines for a quartic, as on long cells, there is no fit to speak of.
        const bool lines = found.choice[i] == lowered && enough;
        const bool wrong = found.choice[i] == clean && difference[i] > of_blur * blur[i] + of_rough * rough[i];
        if (!lines && !wrong) continue;
        found.density[i] = own[i];
        found.choice[i] = one_ring_choice;
    }
}

}  // namespace gaussmap
