// Every analytic surface, plain and jittered: on its equation, closed or open as told, wound outwards, with the normals
// and curvatures that finite differences of an independent parametrisation measure.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "gaussmap/inspect.h"
#include "gaussmap/surfaces.h"
#include "surface_cases.h"

namespace {

using namespace surface_cases;

constexpr SurfaceOptions plain{}, jittered{0.25, 0, 7};

class EverySurface : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Surfaces, EverySurface, testing::ValuesIn(all_cases()),
                         [](const auto& instance) { return instance.param.name; });

void expect_sizes(const Surface& s) {
    const std::size_t n = s.k1.size();
    EXPECT_EQ(s.vertices.size(), 3 * n);
    EXPECT_EQ(s.normals.size(), 3 * n);
    EXPECT_EQ(s.k2.size(), n);
    EXPECT_EQ(s.density.size(), n);
}

TEST_P(EverySurface, HasItsTopology) {
    for (const SurfaceOptions& options : {plain, jittered}) {
        const Surface s = GetParam().make(options);
        expect_sizes(s);
        const gaussmap::Inspection found = gaussmap::inspect(s.vertices, s.faces);
        EXPECT_EQ(static_cast<int>(found.vertices) - static_cast<int>(found.edges) + static_cast<int>(found.faces),
                  GetParam().euler);
        EXPECT_EQ(found.boundary_edges == 0, GetParam().closed);
        EXPECT_EQ(found.components, 1u);
        EXPECT_EQ(found.inconsistent_edges, 0u);
        EXPECT_EQ(found.non_manifold_edges, 0u);
        EXPECT_EQ(found.non_manifold_vertices, 0u);
        EXPECT_EQ(found.degenerate_faces, 0u);
        EXPECT_EQ(found.duplicate_vertices, 0u);
        EXPECT_EQ(found.isolated_vertices, 0u);
        EXPECT_EQ(found.non_finite, 0u);
    }
}

TEST_P(EverySurface, IsWoundToTheSideOfItsNormals) {
    for (const SurfaceOptions& options : {plain, jittered}) {
        const Surface s = GetParam().make(options);
        std::size_t wrong = 0;
        for (std::size_t f = 0; f < s.faces.size(); f += 3) {
            const auto a = static_cast<std::size_t>(s.faces[f]), b = static_cast<std::size_t>(s.faces[f + 1]),
                       c = static_cast<std::size_t>(s.faces[f + 2]);
            const Vec p = vec(s.vertices, a);
            const Vec n = cross(vec(s.vertices, b) - p, vec(s.vertices, c) - p);
            for (const std::size_t v : {a, b, c}) wrong += dot(n, vec(s.normals, v)) > 0 ? 0 : 1;
        }
        EXPECT_EQ(wrong, 0u) << "jitter " << options.jitter;
    }
}

TEST_P(EverySurface, LiesOnItsEquation) {
    for (const SurfaceOptions& options : {plain, jittered}) {
        const Surface s = GetParam().make(options);
        double worst = 0;
        for (std::size_t v = 0; v < s.k1.size(); v += 3)
            worst = std::max(worst, std::abs(GetParam().equation(vec(s.vertices, v))));
        EXPECT_LT(worst, 1e-14) << "jitter " << options.jitter;
    }
}

TEST_P(EverySurface, HasTheNormalsAndCurvaturesOfItsParametrisation) {
    for (const SurfaceOptions& options : {plain, jittered}) {
        const Surface s = GetParam().make(options);
        double unit_error = 0, normal_error = 0, k1_error = 0, k2_error = 0;
        for (std::size_t v = 0; v < s.k1.size(); v += 13) {
            const Vec p = vec(s.vertices, v), n = vec(s.normals, v);
            const Measured truth = measure(GetParam().patch_about(p, n), n);
            unit_error = std::max(unit_error, std::abs(norm(n) - 1));
            normal_error = std::max(normal_error, norm(n - truth.normal));
            // H ± √(H² − K) loses half the digits at umbilics, so the measured sum and product are what is compared.
            const double scale = std::abs(truth.k1) + std::abs(truth.k2) + 1;
            k1_error = std::max(k1_error, std::abs(s.k1[v] + s.k2[v] - truth.k1 - truth.k2) / scale);
            k2_error = std::max(k2_error, std::abs(s.k1[v] * s.k2[v] - truth.k1 * truth.k2) / (scale * scale));
            EXPECT_GE(s.k1[v], s.k2[v]);
            EXPECT_EQ(s.density[v], s.k1[v] * s.k1[v] + s.k2[v] * s.k2[v]);
        }
        EXPECT_LT(unit_error, 1e-15 * 4);
        EXPECT_LT(normal_error, 1e-8);
        EXPECT_LT(k1_error, 1e-7);
        EXPECT_LT(k2_error, 1e-7);
    }
}

/// Σ K dA with a third of each face's area at each of its corners.
double total_gauss(const Surface& s) {
    double sum = 0;
    for (std::size_t f = 0; f < s.faces.size(); f += 3) {
        const auto a = static_cast<std::size_t>(s.faces[f]), b = static_cast<std::size_t>(s.faces[f + 1]),
                   c = static_cast<std::size_t>(s.faces[f + 2]);
        const Vec p = vec(s.vertices, a);
        const double area = norm(cross(vec(s.vertices, b) - p, vec(s.vertices, c) - p)) / 2;
        sum += area / 3 * (s.k1[a] * s.k2[a] + s.k1[b] * s.k2[b] + s.k1[c] * s.k2[c]);
    }
    return sum;
}

TEST(GaussBonnet, HoldsWhereTheTotalIsKnown) {
    for (const Case& c : all_cases()) {
        if (std::isnan(c.total_gauss)) continue;
        EXPECT_NEAR(total_gauss(c.make(plain)), c.total_gauss, 0.1) << c.name;
    }
}

TEST(GaussBonnet, ConvergesQuadratically) {
    const auto error = [](const Surface& s, double exact) { return total_gauss(s) - exact; };
    const double round = 4 * std::numbers::pi;
    EXPECT_NEAR(error(gaussmap::sphere(4), round) / error(gaussmap::sphere(5), round), 4, 0.1);
    EXPECT_NEAR(
        error(gaussmap::bumpy_sphere(1.5, 0.2, 4, 5), round) / error(gaussmap::bumpy_sphere(1.5, 0.2, 4, 6), round), 4,
        0.1);
    EXPECT_NEAR(error(gaussmap::torus_knot(2, 3, 1, 0.4, 0.12, 300, 24), 0) /
                    error(gaussmap::torus_knot(2, 3, 1, 0.4, 0.12, 600, 48), 0),
                4, 0.1);
    EXPECT_NEAR(error(gaussmap::figure_eight_knot(0.5, 0.1, 400, 24), 0) /
                    error(gaussmap::figure_eight_knot(0.5, 0.1, 800, 48), 0),
                4, 0.1);
}

TEST_P(EverySurface, JitterMovesTheInsideAndKeepsTheBorder) {
    const Surface still = GetParam().make(plain), moved = GetParam().make(jittered);
    EXPECT_EQ(still.faces, moved.faces);
    std::vector<int> uses(still.k1.size());
    for (const std::int32_t v : still.faces) ++uses[static_cast<std::size_t>(v)];
    std::size_t fixed = 0;
    double furthest = 0;
    for (std::size_t v = 0; v < still.k1.size(); ++v) {
        const double step = norm(vec(moved.vertices, v) - vec(still.vertices, v));
        furthest = std::max(furthest, step);
        if (step == 0) ++fixed;
        const bool inside = uses[v] >= 5;  // 6 faces, 5 at a corner of the icosahedron, at most 3 on a border
        EXPECT_TRUE(step > 0 || !inside) << v;
    }
    const gaussmap::Inspection found = gaussmap::inspect(still.vertices, still.faces);
    EXPECT_EQ(fixed, found.boundary_edges);  // a closed border has as many vertices as edges
    EXPECT_GT(furthest, 0.1 * found.mean_edge);
    EXPECT_LT(furthest, 1.5 * found.mean_edge);
}

TEST_P(EverySurface, NoiseIsGaussianAndLeavesTheTruthAlone) {
    const Surface clean = GetParam().make(jittered), noisy = GetParam().make({0.25, 0.02, 7});
    EXPECT_EQ(clean.normals, noisy.normals);
    EXPECT_EQ(clean.k1, noisy.k1);
    EXPECT_EQ(clean.density, noisy.density);
    const double edge = gaussmap::inspect(clean.vertices, clean.faces).mean_edge;
    double sum = 0, squares = 0, fourth = 0;
    for (std::size_t i = 0; i < clean.vertices.size(); ++i) {
        const double d = (noisy.vertices[i] - clean.vertices[i]) / (0.02 * edge);
        sum += d, squares += d * d, fourth += d * d * d * d;
    }
    const auto n = static_cast<double>(clean.vertices.size());
    EXPECT_NEAR(sum / n, 0, 4 / std::sqrt(n));
    EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2 / n) + 0.01);
    EXPECT_NEAR(fourth / n, 3, 5 * std::sqrt(96 / n) + 0.03);
}

TEST_P(EverySurface, NoiseRelativeToTheDiagonalIsTheSameScaled) {
    const Surface clean = GetParam().make(jittered), edge = GetParam().make({0.25, 0.02, 7}),
                  diagonal = GetParam().make({0.25, 0.02, 7, gaussmap::NoiseUnit::diagonal});
    const gaussmap::Inspection found = gaussmap::inspect(clean.vertices, clean.faces);
    double squares = 0, ratio = 0;
    for (std::size_t i = 0; i < clean.vertices.size(); ++i) {
        const double by_edge = edge.vertices[i] - clean.vertices[i];
        squares += by_edge * by_edge;
        ratio += by_edge * (diagonal.vertices[i] - clean.vertices[i]);
    }
    // The mean side counts an edge once for each of its faces.
    EXPECT_NEAR(ratio / squares, found.diagonal / found.mean_edge, 0.02 * found.diagonal / found.mean_edge);
    EXPECT_EQ(clean.normals, diagonal.normals);
}

TEST_P(EverySurface, DependsOnTheSeedAlone) {
    const Surface once = GetParam().make({0.25, 0.1, 7}), again = GetParam().make({0.25, 0.1, 7});
    EXPECT_EQ(once.vertices, again.vertices);
    EXPECT_EQ(once.normals, again.normals);
    EXPECT_NE(once.vertices, GetParam().make({0.25, 0.1, 8}).vertices);
}

}  // namespace
