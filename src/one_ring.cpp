#include "one_ring.h"

#include <cmath>
#include <limits>
#include <vector>

#include "corrected_curvature.h"

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

/// Whether faces go all the way round each vertex: on borders the one-ring is one-sided, and errs with the edge's
/// length rather than with its square.
std::vector<std::uint8_t> whole_rings(Triangles faces, const VertexRings& rings, std::size_t count) {
    std::vector<std::uint32_t> corners(count, 0);
    for (std::size_t f = 0; f < faces.count; ++f)
        for (int c = 0; c < 3; ++c) ++corners[static_cast<std::size_t>(faces[f][c])];
    std::vector<std::uint8_t> whole(count);
    for (std::size_t v = 0; v < count; ++v) whole[v] = corners[v] >= rings.degree(v);
    return whole;
}

}  // namespace

void take_one_rings(Points vertices, Triangles faces, const VertexRings& rings, Points fitted_normals,
                    Points mesh_normals, AutomaticCurvature& found, const Execution& run) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr std::uint8_t clean = 2;
    const std::size_t count = found.density.size();
    const std::vector<double> corrected = corrected_density(vertices, faces, fitted_normals, run);
    const std::vector<std::uint8_t> whole = whole_rings(faces, rings, count);
    // Relative to the fits: squares of densities have no place among floats.
    std::vector<float> change(count, nan), difference(count, nan), blur(count, nan);
    for (std::size_t i = 0; i < count; ++i) {
        if (found.choice[i] != clean || !whole[i]) continue;
        change[i] = static_cast<float>((corrected[i] - found.density[i]) * found.unit);
        difference[i] = change[i] * change[i];
        blur[i] = static_cast<float>(std::pow((mean_around(i, corrected, rings) - corrected[i]) * found.unit, 2));
    }
    std::vector<float> rough = roughness(change, found.graph, run);
    for (auto* field : {&rough, &difference, &blur}) diffuse(*field, found.graph, reach, run);
    const std::vector<double> own = corrected_density(vertices, faces, mesh_normals, run);
    for (std::size_t i = 0; i < count; ++i) {
        if (!std::isfinite(change[i]) || !std::isfinite(own[i])) continue;
        if (!(difference[i] > of_blur * blur[i] + of_rough * rough[i])) continue;
        found.density[i] = own[i];
        found.choice[i] = one_ring_choice;
    }
}

}  // namespace gaussmap
