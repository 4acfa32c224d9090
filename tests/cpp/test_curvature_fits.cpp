// `Estimator::jet` and `regression` on meshes: exact cases, truth, invariances, odd meshes, messages.
#include <algorithm>
#include <limits>

#include "clouds.h"
#include "gaussmap/curvature.h"
#include "gaussmap/surfaces.h"
#include "mesh_cases.h"
#include "support.h"

using namespace gaussmap;

namespace {

using Array = std::vector<double>;
using Indices = std::vector<std::int32_t>;
constexpr SurfaceOptions jittered = {.jitter = 0.25, .noise = 0, .seed = 7};

MeshCurvatureOptions jet(int degree, int k = 20, int threads = 0) {
    MeshCurvatureOptions options;
    options.estimator = Estimator::jet;
    options.k = k;
    options.degree = degree;
    options.confidence = options.tensor = true;
    options.run.threads = threads;
    return options;
}

MeshCurvatureOptions regression(int k = 20, int threads = 0) {
    MeshCurvatureOptions options = jet(4, k, threads);
    options.estimator = Estimator::regression;
    return options;
}

double relative_error(const Array& density, const Array& truth) {
    double squares = 0;
    for (const double t : truth) squares += t * t;
    return support::rmse(density, truth) / std::sqrt(squares / static_cast<double>(truth.size()));
}

TEST(MeshFits, ExactCases) {
    // Regression on given normals; jets only where the surface is a polynomial.
    const Surface ball = sphere(3, 2, jittered), tube = cylinder(0.5, 2, 40, 30, jittered);
    for (const Surface& s : {ball, tube}) {
        const MeshCurvature result = mesh_curvature(s.vertices, s.faces, s.normals, regression());
        EXPECT_EQ(result.undefined, 0u);
        for (std::size_t i = 0; i < s.density.size(); ++i) {
            EXPECT_NEAR(result.density[i], s.density[i], 1e-9 * s.density[i]);
            EXPECT_NEAR(result.vertex_tensor.k1[i], s.k1[i], 1e-9);
        }
    }
    const Surface flat = plane(1, 1, 30, 30, jittered);
    for (const MeshCurvatureOptions& options : {jet(2), jet(4), regression()})
        for (const double d : mesh_curvature(flat.vertices, flat.faces, {}, options).density) EXPECT_LT(d, 1e-18);
}

TEST(MeshFits, Truth) {
    struct Case {
        MeshCurvatureOptions options;
        bool given;
        double most;
    };
    const Case cases[] = {{jet(2, 12), false, 0.06},     {jet(3), false, 0.035},       {jet(4), false, 0.003},
                          {regression(12), true, 0.015}, {regression(), false, 0.025}, {regression(), true, 0.025}};
    for (const Surface& s : {torus(1, 0.4, 90, 50, jittered), ellipsoid(1, 0.7, 0.5, 4, jittered)})
        for (const auto& [options, given, most] : cases) {
            const MeshCurvature result = mesh_curvature(s.vertices, s.faces, given ? s.normals : Array(), options);
            EXPECT_EQ(result.undefined + result.lowered, 0u);
            EXPECT_LT(relative_error(result.density, s.density), most);
            EXPECT_EQ(result.choice.size(), 0u);
            EXPECT_EQ(result.kappa.size(), s.faces.size() / 3);
            for (std::size_t i = 0; i < s.density.size(); ++i) {
                const double k1 = result.vertex_tensor.k1[i], k2 = result.vertex_tensor.k2[i];
                EXPECT_NEAR(k1 * k1 + k2 * k2, result.density[i], 1e-9 * result.density[i]);
                EXPECT_GT(result.error[i], 0);
            }
        }
}

TEST(MeshFits, SidesAreThoseOfTheFaces) {
    const Surface s = ellipsoid(1, 0.7, 0.5, 3, jittered);
    Indices turned(s.faces.rbegin(), s.faces.rend());
    for (const MeshCurvatureOptions& options : {jet(4), regression()}) {
        const MeshCurvature out = mesh_curvature(s.vertices, s.faces, {}, options);
        const MeshCurvature in = mesh_curvature(s.vertices, turned, {}, options);
        for (std::size_t i = 0; i < s.density.size(); ++i) {
            EXPECT_NEAR(out.vertex_tensor.k1[i], s.k1[i], 0.1 * s.k1[i]);
            EXPECT_NEAR(in.vertex_tensor.k2[i], -out.vertex_tensor.k1[i], 1e-6 * s.k1[i]);
            EXPECT_EQ(in.normals[3 * i], -out.normals[3 * i]);
        }
    }
}

TEST(MeshFits, MovedTurnedScaledRenumbered) {
    Surface s = torus(1, 0.4, 40, 24, jittered);
    for (double& x : s.vertices) x = std::round(x * 0x1p20) * 0x1p-20;  // exact far away too
    const std::size_t n = s.density.size();
    Array moved = s.vertices, tripled = s.vertices, renumbered(3 * n);
    for (double& x : moved) x += 0x1p21;
    for (double& x : tripled) x *= 3;
    support::Random random(3);
    const Array rotated = support::times(support::random_rotation(random), s.vertices);
    for (std::size_t i = 0; i < n; ++i) std::copy_n(&s.vertices[3 * i], 3, &renumbered[3 * (n - 1 - i)]);
    Indices faces = s.faces;
    for (std::int32_t& v : faces) v = static_cast<std::int32_t>(n) - 1 - v;
    for (const MeshCurvatureOptions& options : {jet(3), regression()}) {
        const auto density = [&](const Array& vertices) {
            return mesh_curvature(vertices, s.faces, {}, options).density;
        };
        const Array here = density(s.vertices), there = density(moved), turned = density(rotated);
        const Array large = density(tripled), last_first = mesh_curvature(renumbered, faces, {}, options).density;
        for (std::size_t i = 0; i < n; ++i) {
            EXPECT_NEAR(there[i], here[i], 1e-6 * here[i]);
            EXPECT_NEAR(turned[i], here[i], 1e-6 * here[i]);
            EXPECT_NEAR(9 * large[i], here[i], 1e-6 * here[i]);
            EXPECT_NEAR(last_first[n - 1 - i], here[i], 1e-6 * here[i]);
        }
    }
}

TEST(MeshFits, SameBitsForAnyThreads) {
    const Surface s = torus(1, 0.4, 40, 24, jittered);
    for (const auto& make :
         {+[](int threads) { return jet(4, 20, threads); }, +[](int threads) { return regression(20, threads); }}) {
        const MeshCurvature one = mesh_curvature(s.vertices, s.faces, {}, make(1));
        for (const int threads : {2, 7}) {
            const MeshCurvature more = mesh_curvature(s.vertices, s.faces, {}, make(threads));
            support::expect_same_bits(one, more);
        }
    }
}

TEST(MeshFits, Borders) {
    const Surface s = waves(1, 1, 0.03, 1, 50, 50, jittered);
    for (const MeshCurvatureOptions& options : {jet(3), regression(12)}) {
        const MeshCurvature result = mesh_curvature(s.vertices, s.faces, {}, options);
        EXPECT_EQ(result.undefined, 0u);
        EXPECT_LT(relative_error(result.density, s.density), 0.15);
    }
}

TEST(MeshFits, OddMeshes) {
    const Surface s = support::odd_sphere();
    const auto n = static_cast<std::int32_t>(s.density.size());
    for (const MeshCurvatureOptions& options : {jet(4), regression()}) {
        const MeshCurvature result = mesh_curvature(s.vertices, s.faces, {}, options);
        EXPECT_EQ(result.undefined, 2u);
        for (const auto i : {n, n + 1}) {
            const auto at = static_cast<std::size_t>(i);
            EXPECT_TRUE(std::isnan(result.density[at]) && std::isnan(result.error[at]));
            EXPECT_TRUE(std::isnan(result.vertex_tensor.k1[at]));
        }
        // All but those on whose rings the odd face brings vertices from afar.
        std::size_t off = 0;
        for (std::size_t i = 0; i < s.density.size(); ++i) off += std::abs(result.density[i] - 2) > 0.1;
        EXPECT_LT(off, 25u);
    }
}

TEST(MeshFits, FewNeighbours) {
    const Array tetrahedron = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const Indices faces = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    EXPECT_EQ(mesh_curvature(tetrahedron, faces, {}, jet(4)).undefined, 4u);
    EXPECT_EQ(mesh_curvature({}, {}, {}, jet(4)).density.size(), 0u);
    const Surface ball = sphere(0);  // eleven others, enough for a cubic at most
    const MeshCurvature result = mesh_curvature(ball.vertices, ball.faces, {}, jet(4));
    EXPECT_EQ(result.lowered, 12u);
    EXPECT_EQ(result.undefined, 0u);
}

TEST(MeshFits, Messages) {
    const Surface s = sphere(1);
    const auto message = [&](const MeshCurvatureOptions& options) {
        return support::refusal([&] { mesh_curvature(s.vertices, s.faces, {}, options); });
    };
    EXPECT_EQ(message(jet(1)), "degree = 1 has no curvature; estimator = jet takes 2 to 4");
    EXPECT_EQ(message(jet(5)), "degree = 5 is outside 1 to 4");
    EXPECT_EQ(message(jet(2, 4)), "k = 4 is too small; estimator = jet takes at least 5 neighbours");
    EXPECT_EQ(message(regression(2)), "k = 2 is too small; estimator = regression takes at least 3 neighbours");
}

}  // namespace
