// `Estimator::automatic` on meshes: against the truth, against the one-ring estimators, invariances, odd meshes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "gaussmap/curvature.h"
#include "gaussmap/surfaces.h"
#include "mesh_cases.h"
#include "support.h"

using namespace gaussmap;

namespace {

using Array = std::vector<double>;
using Indices = std::vector<std::int32_t>;
constexpr SurfaceOptions jittered = {.jitter = 0.25, .noise = 0, .seed = 7};
constexpr SurfaceOptions noisy = {.jitter = 0.25, .noise = 0.01, .seed = 7};

MeshCurvature by(Estimator estimator, const Array& vertices, const Indices& faces, int threads = 0) {
    MeshCurvatureOptions options;
    options.estimator = estimator;
    options.run.threads = threads;
    options.confidence = options.tensor = estimator == Estimator::automatic;
    return mesh_curvature(vertices, faces, {}, options);
}

MeshCurvature automatic(const Surface& s, int threads = 0) {
    return by(Estimator::automatic, s.vertices, s.faces, threads);
}

double error_of(const Surface& s, Estimator estimator) {
    return support::rmse(by(estimator, s.vertices, s.faces).density, s.density);
}

double best_of_one_rings(const Surface& s) {
    return std::min(error_of(s, Estimator::dirichlet), error_of(s, Estimator::corrected));
}

/// Part of the vertices whose truth lies within two standard errors.
double covered(const MeshCurvature& result, const Array& truth) {
    std::size_t within = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        within += std::abs(result.density[i] - truth[i]) < 2 * result.error[i] ? 1 : 0;
    return static_cast<double>(within) / static_cast<double>(truth.size());
}

double greatest_change(const Array& a, const Array& b, double factor = 1) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(b[i] * factor / a[i] - 1));
    return most;
}

TEST(AutoMesh, FarBetterThanOneRingsOnIrregularMeshes) {
    for (const Surface& s : {torus(1, 0.4, 90, 50, jittered), ellipsoid(1, 0.7, 0.5, 4, jittered),
                             waves(1, 1, 0.05, 0.7, 60, 60, jittered)}) {
        const MeshCurvature result = automatic(s);
        EXPECT_EQ(result.undefined, 0u);
        EXPECT_LT(support::rmse(result.density, s.density), 0.15 * best_of_one_rings(s));
    }
}

TEST(AutoMesh, FarBetterThanOneRingsUnderNoise) {
    const Surface s = torus(1, 0.4, 90, 50, noisy);
    EXPECT_LT(error_of(s, Estimator::automatic), 0.25 * best_of_one_rings(s));
}

TEST(AutoMesh, NoWorseThanOneRingsOnGrids) {
    const Surface surfaces[] = {torus(1, 0.4, 90, 50),
                                torus(1, 0.4, 60, 90),
                                torus_knot(2, 3, 1, 0.4, 0.15, 300, 24),
                                torus_knot(2, 3, 1, 0.4, 0.15, 200, 80),
                                figure_eight_knot(1.0 / 3, 0.1, 300, 24),
                                torus(1, 0.1, 200, 12),
                                torus(1, 0.5, 18, 18),
                                torus(1, 0.7, 200, 40),
                                ellipsoid(1, 0.7, 0.5, 3),
                                waves(1, 1, 0.05, 0.7, 60, 60),
                                waves(1, 1, 0.05, 0.7, 90, 30),
                                catenoid(1, 2, 90, 45)};
    for (const Surface& s : surfaces)
        EXPECT_LT(error_of(s, Estimator::automatic), 1.1 * best_of_one_rings(s)) << s.density.size();
}

TEST(AutoMesh, FitsStandWhereTheLaplacianOfTheDensityVanishes) {
    // Somewhere on each the average over the one-ring changes nothing, and so tells nothing of the one-ring's error.
    for (const Surface& s : {catenoid(1, 2, 132, 100), torus(1, 0.5, 280, 56), waves(1, 1, 0.05, 0.5, 160, 80)})
        EXPECT_LT(error_of(s, Estimator::automatic), 0.05 * best_of_one_rings(s)) << s.density.size();
}

TEST(AutoMesh, WhereResidualsVanishIsNoNoise) {
    // The remainders of a monkey saddle change their sign along curves, beside which their variances scatter like those
    // of noise.
    constexpr int n = 120;
    Array vertices, density;
    Indices faces;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = 2.0 * i / (n - 1) - 1, y = 2.0 * j / (n - 1) - 1;
            vertices.insert(vertices.end(), {x, y, (x * x * x - 3 * x * y * y) / 3});
            const double zx = x * x - y * y, zy = -2 * x * y, zxx = 2 * x, zxy = -2 * y, w = 1 + zx * zx + zy * zy;
            const double mean =
                ((1 + zy * zy) * zxx - 2 * zx * zy * zxy - (1 + zx * zx) * zxx) / (2 * std::pow(w, 1.5));
            density.push_back(4 * mean * mean + 2 * (zxx * zxx + zxy * zxy) / (w * w));
            const std::int32_t at = i * n + j;
            if (i + 1 < n && j + 1 < n) faces.insert(faces.end(), {at, at + n, at + 1, at + 1, at + n, at + n + 1});
        }
    const MeshCurvature result = by(Estimator::automatic, vertices, faces);
    for (const std::uint8_t choice : result.choice) ASSERT_STREQ(choice_name(choice), "quartic 24");
    EXPECT_LT(support::rmse(result.density, density), 1e-4);
}

TEST(AutoMesh, OneRingsTellTheirOwnError) {
    for (const Surface& s : {torus_knot(2, 3, 1, 0.4, 0.15, 300, 24), figure_eight_knot(1.0 / 3, 0.1, 300, 24)}) {
        const MeshCurvature result = automatic(s);
        std::size_t taken = 0, covered = 0;
        double told = 0, made = 0;
        for (std::size_t i = 0; i < s.density.size(); ++i) {
            if (std::string(choice_name(result.choice[i])) != "corrected") continue;
            const double error = result.density[i] - s.density[i];
            ++taken, covered += std::abs(error) < 2 * result.error[i];
            told += result.error[i] * result.error[i], made += error * error;
        }
        EXPECT_GT(taken, s.density.size() / 2);
        EXPECT_GT(static_cast<double>(covered), 0.9 * static_cast<double>(taken));
        EXPECT_LT(told, 9 * made) << "not by being large";
    }
}

TEST(AutoMesh, SpheresAndPlanesAreExact) {
    const MeshCurvature round = by(Estimator::automatic, sphere(3, 2, jittered).vertices, sphere(3, 2).faces);
    for (const double d : round.density) EXPECT_NEAR(d, 0.5, 1e-6);
    const Surface flat = plane(1, 1, 30, 30, jittered);
    for (const double d : automatic(flat).density) EXPECT_LT(d, 1e-20);
}

TEST(AutoMesh, ConfidenceCoversTheTruth) {
    for (const Surface& s : {ellipsoid(1, 0.7, 0.5, 4, jittered), torus(1, 0.4, 90, 50, noisy)}) {
        const MeshCurvature result = automatic(s);
        EXPECT_GT(covered(result, s.density), 0.9);
    }
}

TEST(AutoMesh, HalfOfTheVerticesTellHowFarErrorsReach) {
    // Without them two errors hold 0.998.
    const Surface s = torus(1, 0.7, 120, 90, jittered);
    const MeshCurvature result = automatic(s);
    EXPECT_GT(covered(result, s.density), 0.92);
    EXPECT_LT(covered(result, s.density), 0.985);

    // Vertices of no face are not of the half.
    Array vertices = {NAN, 0, 0, 0.1, 0.2, 0.3};
    vertices.insert(vertices.end(), s.vertices.begin(), s.vertices.end());
    Indices faces = s.faces;
    for (std::int32_t& v : faces) v += 2;
    const MeshCurvature more = by(Estimator::automatic, vertices, faces);
    EXPECT_TRUE(support::same_bits({more.error.begin() + 2, more.error.end()}, result.error));
}

TEST(AutoMesh, MovedTurnedScaled) {
    Surface s = torus(1, 0.4, 40, 24, jittered);
    for (double& x : s.vertices) x = std::round(x * 0x1p20) * 0x1p-20;  // exact far away too
    const MeshCurvature here = automatic(s);
    Array moved = s.vertices, doubled = s.vertices, tripled = s.vertices;
    for (double& x : moved) x += 0x1p21;
    for (double& x : doubled) x *= 2;
    for (double& x : tripled) x *= 3;
    support::Random random(3);
    const Array turned = support::times(support::random_rotation(random), s.vertices);
    const auto density = [&](const Array& vertices) { return by(Estimator::automatic, vertices, s.faces).density; };
    EXPECT_LT(greatest_change(here.density, density(moved)), 1e-6);
    EXPECT_LT(greatest_change(here.density, density(turned)), 1e-6);
    EXPECT_LT(greatest_change(here.density, density(tripled), 9), 1e-6);
    EXPECT_EQ(greatest_change(here.density, density(doubled), 4), 0);
}

TEST(AutoMesh, OrderAndWindingAreImmaterial) {
    const Surface s = torus(1, 0.4, 40, 24, jittered);
    const MeshCurvature here = automatic(s);
    const std::size_t n = s.density.size();
    // Vertex i becomes n − 1 − i; faces come backwards and wound the other way.
    Array vertices(3 * n);
    for (std::size_t i = 0; i < n; ++i) std::copy_n(&s.vertices[3 * i], 3, &vertices[3 * (n - 1 - i)]);
    Indices faces(s.faces.rbegin(), s.faces.rend());
    for (std::int32_t& v : faces) v = static_cast<std::int32_t>(n) - 1 - v;
    const MeshCurvature there = by(Estimator::automatic, vertices, faces);
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_NEAR(there.density[n - 1 - i], here.density[i], 1e-6 * here.density[i]);
        EXPECT_NEAR(there.vertex_tensor.k1[n - 1 - i], -here.vertex_tensor.k2[i], 1e-5);
        EXPECT_NEAR(there.normals[3 * (n - 1 - i)], -here.normals[3 * i], 1e-6);
        EXPECT_NEAR(here.vertex_tensor.k1[i], s.k1[i], 0.05);
    }
}

TEST(AutoMesh, SameBitsForAnyThreads) {
    const Surface s = torus(1, 0.4, 40, 24, noisy);
    const MeshCurvature one = automatic(s, 1);
    for (const int threads : {2, 7}) {
        const MeshCurvature more = automatic(s, threads);
        support::expect_same_bits(one, more);
        EXPECT_EQ(one.choice, more.choice);
    }
}

TEST(AutoMesh, OddMeshes) {
    const Surface s = support::odd_sphere();
    const auto n = static_cast<std::int32_t>(s.density.size());
    const MeshCurvature result = by(Estimator::automatic, s.vertices, s.faces);
    EXPECT_EQ(result.undefined, 2u);
    EXPECT_TRUE(std::isnan(result.density[static_cast<std::size_t>(n)]));
    EXPECT_TRUE(std::isnan(result.density[static_cast<std::size_t>(n) + 1]));
    for (std::size_t i = 0; i < s.density.size(); ++i) EXPECT_NEAR(result.density[i], 2, 1e-6);
}

TEST(AutoMesh, TinyMeshes) {
    const Array tetrahedron = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    EXPECT_EQ(by(Estimator::automatic, tetrahedron, {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}).undefined, 4u);
    EXPECT_EQ(by(Estimator::automatic, {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}).undefined, 3u);
    EXPECT_EQ(by(Estimator::automatic, {}, {}).density.size(), 0u);
    EXPECT_THROW(by(Estimator::automatic, {0, 0, 0}, {0, 0, 1}), std::invalid_argument);
}

TEST(AutoMesh, NearSheetsStayOut) {
    // Two spheres nearer to each other than an edge.
    Surface s = sphere(3);
    const std::size_t n = s.density.size();
    for (std::size_t i = 0; i < 3 * n; ++i) s.vertices.push_back(1.02 * s.vertices[i]);
    for (std::size_t i = 0, m = s.faces.size(); i < m; ++i)
        s.faces.push_back(s.faces[i] + static_cast<std::int32_t>(n));
    const MeshCurvature result = automatic(s);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(result.density[i], 2, 1e-6);
}

}  // namespace
