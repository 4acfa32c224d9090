// Each face of the icosahedron carries a triangular lattice whose points have numbers known in advance (corners, then
// edges, then insides), so the halves of an edge find each other without a search.

#include "icosphere.h"

#include <array>
#include <cmath>
#include <numbers>

#include "analytic.h"

namespace gaussmap {
namespace {

using Corners = std::array<Vec3, 12>;

/// (±1, ±φ, 0), (0, ±1, ±φ), (±φ, 0, ±1): three golden rectangles.
Corners icosahedron_corners() {
    const double big = std::numbers::phi / std::sqrt(1 + std::numbers::phi * std::numbers::phi);
    const double small = 1 / std::sqrt(1 + std::numbers::phi * std::numbers::phi);
    Corners corners;
    std::size_t n = 0;
    for (const double a : {-small, small})
        for (const double b : {-big, big}) {
            corners[n++] = {a, b, 0};
            corners[n++] = {0, a, b};
            corners[n++] = {b, 0, a};
        }
    return corners;
}

/// Each has five neighbours at distance 2·small ≈ 1.05; the others are at 1.7 or more.
bool joined(const Corners& corners, int a, int b) {
    return a != b && squared(corners[a] - corners[b]) < 2;
}

/// The lattice over one face a < b < c of the icosahedron: point (i, j), 0 ≤ j ≤ i ≤ n, lies j/i of the way along row
/// i, from edge ab to edge ac; row 0 is a, row n is edge bc.
struct Lattice {
    std::int32_t n;
    std::int32_t a, b, c;     ///< vertices at the corners
    std::int32_t ab, ac, bc;  ///< first vertex inside each edge, counted from its lower corner
    std::int32_t inside;      ///< first vertex inside the face

    std::int32_t vertex(std::int32_t i, std::int32_t j) const {
        if (i == 0) return a;
        if (i == n) return j == 0 ? b : j == n ? c : bc + j - 1;
        if (j == 0) return ab + i - 1;
        if (j == i) return ac + i - 1;
        return inside + (i - 1) * (i - 2) / 2 + j - 1;
    }
};

std::vector<Lattice> lattices(const Corners& corners, std::int32_t n) {
    std::array<std::array<std::int32_t, 12>, 12> edge{};
    std::int32_t next = 12;
    for (int a = 0; a < 12; ++a)
        for (int b = a + 1; b < 12; ++b)
            if (joined(corners, a, b)) edge[a][b] = next, next += n - 1;
    std::vector<Lattice> faces;
    for (int a = 0; a < 12; ++a)
        for (int b = a + 1; b < 12; ++b)
            for (int c = b + 1; c < 12; ++c)
                if (joined(corners, a, b) && joined(corners, b, c) && joined(corners, a, c)) {
                    faces.push_back({n, a, b, c, edge[a][b], edge[a][c], edge[b][c], next});
                    next += (n - 1) * (n - 2) / 2;
                }
    return faces;
}

/// Positions of all points of the lattice but its corners, level by level. Edges are computed by both of their faces,
/// to the same bits: the two ends of a midpoint enter it symmetrically.
void place(const Lattice& lattice, std::vector<double>& directions) {
    const auto at = [&](std::int32_t i, std::int32_t j) {
        return directions.data() + 3 * static_cast<std::size_t>(lattice.vertex(i, j));
    };
    for (std::int32_t step = lattice.n / 2; step >= 1; step /= 2)
        for (std::int32_t i = 0; i <= lattice.n; i += step)
            for (std::int32_t j = 0; j <= i; j += step) {
                const std::int32_t di = i & step, dj = j & step;
                if (di || dj) store(at(i, j), normalized(load(at(i - di, j - dj)) + load(at(i + di, j + dj))));
            }
}

void add_faces(const Lattice& lattice, bool turned, std::vector<std::int32_t>& faces) {
    const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
        faces.insert(faces.end(), {a, turned ? c : b, turned ? b : c});
    };
    for (std::int32_t i = 0; i < lattice.n; ++i)
        for (std::int32_t j = 0; j <= i; ++j) {
            const std::int32_t corner = lattice.vertex(i, j), far = lattice.vertex(i + 1, j + 1);
            add(corner, lattice.vertex(i + 1, j), far);
            if (j < i) add(corner, far, lattice.vertex(i, j + 1));
        }
}

}  // namespace

Icosphere icosphere(int subdivisions) {
    const std::int32_t n = std::int32_t{1} << subdivisions;
    const std::size_t squares = static_cast<std::size_t>(n) * n;
    const Corners corners = icosahedron_corners();
    Icosphere sphere;
    sphere.directions.resize(3 * (10 * squares + 2));
    sphere.faces.reserve(3 * 20 * squares);
    for (std::size_t c = 0; c < corners.size(); ++c) store(sphere.directions.data() + 3 * c, corners[c]);
    for (const Lattice& lattice : lattices(corners, n)) {
        place(lattice, sphere.directions);
        const Vec3 a = corners[lattice.a], b = corners[lattice.b], c = corners[lattice.c];
        add_faces(lattice, dot(a, cross(b, c)) < 0, sphere.faces);
    }
    return sphere;
}

}  // namespace gaussmap
