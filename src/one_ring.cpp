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
/// changes them by 1.7 times as much (second moments of hexagons and of their corners; measured on grids: 1.7 to 1.9).
/// Fits that differ by more than that error are the culprits, as far as their own error explains it. Where it does not,
/// either the fit is blind (quartics over five rows or fewer see no remainder across them) or the ring is: second
/// differences along its diameters may cancel in the mean. Then the fit is the culprit only if it differs by more than
/// those could make out each by itself.
constexpr double of_blur = 0.34, of_bends = 4;
/// The most that an error explains, squared.
constexpr double explained = 4;
/// None of it holds where the difference is rough, as on irregular meshes (the mean square deviation from the mean
/// nearby is 0.7 of the mean square and more): there it is the measures that err.
constexpr double of_rough = 2;
constexpr int reach = 8;  ///< steps of diffusion

/// The neighbours of a vertex, and where they are seen from it.
struct Ring {
    std::vector<std::size_t> vertex;
    std::vector<Vec3> direction;  ///< unit

    void look(std::size_t from, Points vertices, const VertexRings& rings) {
        vertex.clear(), direction.clear();
        for (const std::int32_t v : rings.around(from)) {
            vertex.push_back(static_cast<std::size_t>(v));
            direction.push_back(unit(load(vertices[vertex.back()]) - load(vertices[from])));
        }
    }
    /// The one that lies most nearly opposite to another.
    std::size_t opposite(std::size_t to) const {
        double least = 2;
        std::size_t found = to;
        for (std::size_t j = 0; j < direction.size(); ++j) {
            const double cosine = dot(direction[to], direction[j]);
            if (cosine < least) least = cosine, found = j;
        }
        return vertex[found];
    }
};

/// Half of the second differences of a field along the diameters of a one-ring.
struct Bends {
    double mean, mean_square;
};
Bends bends(std::size_t vertex, const Ring& ring, const std::vector<double>& field) {
    double sum = 0, squares = 0;
    int terms = 0;
    for (std::size_t j = 0; j < ring.vertex.size(); ++j) {
        const double bend = 0.5 * (field[ring.vertex[j]] + field[ring.opposite(j)]) - field[vertex];
        if (std::isfinite(bend)) sum += bend, squares += bend * bend, ++terms;
    }
    return {sum / terms, squares / terms};
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
    const std::vector<double> corrected = corrected_density(vertices, faces, fitted_normals, run),
                              own = corrected_density(vertices, faces, mesh_normals, run);
    // Relative to the fits: squares of densities have no place among floats.
    std::vector<float> change(count, nan), difference(count, nan), blur(count, nan), square(count, nan);
    Ring ring;
    for (std::size_t i = 0; i < count; ++i) {
        if ((found.choice[i] != clean && found.choice[i] != lowered) || !inside(i, rings)) continue;
        ring.look(i, vertices, rings);
        const Bends bent = bends(i, ring, own);
        blur[i] = static_cast<float>(std::pow(bent.mean * found.unit, 2));
        square[i] = static_cast<float>(bent.mean_square * found.unit * found.unit);
        if (found.choice[i] != clean) continue;
        change[i] = static_cast<float>((corrected[i] - found.density[i]) * found.unit);
        difference[i] = change[i] * change[i];
    }
    std::vector<float> rough = roughness(change, found.graph, run);
    for (auto* field : {&rough, &difference, &blur, &square}) diffuse(*field, found.graph, reach, run);
    const bool enough = count > wide_neighbors;
    for (std::size_t i = 0; i < count; ++i) {
        if (found.choice[i] != clean && found.choice[i] != lowered) continue;
        if (!std::isfinite(own[i]) || !inside(i, rings)) continue;
        // Where many neighbours lie on too few lines for a quartic, as on long cells, there is no fit to speak of.
        const bool lines = found.choice[i] == lowered && enough;
        const double unexplained = difference[i] - of_rough * rough[i];
        const bool owned = difference[i] < explained * std::pow(found.error[i] * found.unit, 2);
        const bool wrong = found.choice[i] == clean && unexplained > (owned ? of_blur * blur[i] : of_bends * square[i]);
        if (!lines && !wrong) continue;
        found.density[i] = own[i];
        found.error[i] = std::sqrt(of_blur * blur[i]) / found.unit;
        found.choice[i] = one_ring_choice;
    }
}

}  // namespace gaussmap
