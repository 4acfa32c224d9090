// Total curvature of meshes: exactness, convergence, invariance, robustness, threads, messages.
#include "gaussmap/curvature.h"

#include <algorithm>
#include <limits>

#include "gaussmap/surfaces.h"
#include "support.h"

using namespace gaussmap;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::vector<double> density(const Surface& s, Estimator estimator = Estimator::dirichlet, bool exact_normals = true) {
    MeshCurvatureOptions options;
    options.estimator = estimator;
    return mesh_curvature(s.vertices, s.faces, exact_normals ? Points(s.normals) : Points(), options).density;
}

double largest_relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double scale = 0, worst = 0;
    for (const double v : b)
        if (std::isfinite(v)) scale = std::max(scale, std::abs(v));
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (std::isnan(a[i]) != std::isnan(b[i])) return std::numeric_limits<double>::infinity();
        if (!std::isnan(a[i])) worst = std::max(worst, std::abs(a[i] - b[i]));
    }
    return worst / scale;
}

/// An uneven test surface: jittered, of varying density.
Surface bumpy() {
    return bumpy_sphere(1, 0.2, 3, 4, {.jitter = 0.2, .noise = 0, .seed = 7});
}

Surface permuted(const Surface& s, support::Random& random, std::vector<std::size_t>& new_of_old) {
    const std::size_t n = s.vertices.size() / 3, m = s.faces.size() / 3;
    new_of_old.resize(n);
    for (std::size_t i = 0; i < n; ++i) new_of_old[i] = i;
    for (std::size_t i = n; i > 1; --i) std::swap(new_of_old[i - 1], new_of_old[random.below(i)]);
    std::vector<std::size_t> order(m);
    for (std::size_t i = 0; i < m; ++i) order[i] = i;
    for (std::size_t i = m; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    Surface p = s;
    for (std::size_t i = 0; i < n; ++i)
        for (int c = 0; c < 3; ++c) {
            p.vertices[3 * new_of_old[i] + c] = s.vertices[3 * i + c];
            p.normals[3 * new_of_old[i] + c] = s.normals[3 * i + c];
        }
    for (std::size_t f = 0; f < m; ++f) {
        const std::size_t turn = random.below(3);
        for (std::size_t c = 0; c < 3; ++c)
            p.faces[3 * f + c] = static_cast<std::int32_t>(new_of_old[s.faces[3 * order[f] + (c + turn) % 3]]);
    }
    return p;
}

}  // namespace

TEST(MeshCurvature, TorusMatchesThePapersTable) {
    const double paper[3][2] = {{9, 0.4759}, {18, 0.1425}, {36, 0.0372}};
    for (const auto& [grid, rmse] : paper) {
        const Surface s = torus(1, 0.5, static_cast<int>(grid), static_cast<int>(grid));
        EXPECT_NEAR(support::rmse(density(s), s.density), rmse, 0.00005) << grid;
        EXPECT_NEAR(support::rmse(density(s, Estimator::dirichlet, false), s.density), rmse, 0.00005)
            << grid << " with Max's normals";
    }
}

TEST(MeshCurvature, CorrectedIsCloserOnTheTorus) {
    const double figures[3][3] = {{9, 0.382, 0.0005}, {18, 0.111, 0.0005}, {36, 0.0288, 0.00005}};
    for (const auto& [grid, rmse, digits] : figures) {
        const Surface s = torus(1, 0.5, static_cast<int>(grid), static_cast<int>(grid));
        EXPECT_NEAR(support::rmse(density(s, Estimator::corrected), s.density), rmse, digits) << grid;
    }
}

TEST(MeshCurvature, SphereIsExactToRounding) {
    for (const double radius : {1e-3, 1.0, 250.0}) {
        const Surface s = sphere(4, radius, {.jitter = 0.25, .noise = 0, .seed = 1});
        for (const bool exact : {true, false})
            for (const Estimator e : {Estimator::dirichlet, Estimator::corrected})
                for (const double d : density(s, e, exact)) ASSERT_NEAR(d * radius * radius, 2, 1e-9) << radius;
    }
    const Surface s = sphere(5);
    for (const double d : density(s)) ASSERT_NEAR(d, 2, 1e-11);
}

TEST(MeshCurvature, PlaneIsExactlyZero) {
    const Surface s = plane(3, 2, 20, 30, {.jitter = 0.3, .noise = 0, .seed = 3});
    for (const Estimator e : {Estimator::dirichlet, Estimator::corrected})
        for (const double d : density(s, e, false)) ASSERT_EQ(d, 0.0);
    const MeshCurvature c = mesh_curvature(s.vertices, s.faces);
    for (const double k : c.kappa) ASSERT_EQ(k, 0.0);
    EXPECT_EQ(c.kappa_sum, 0.0);
}

TEST(MeshCurvature, ConvergesQuadraticallyOnRegularGrids) {
    for (const Estimator e : {Estimator::dirichlet, Estimator::corrected}) {
        const Surface coarse = torus(1, 0.4, 40, 24), fine = torus(1, 0.4, 160, 96);
        const double rate = std::log(support::rmse(density(coarse, e), coarse.density) /
                                     support::rmse(density(fine, e), fine.density)) /
                            std::log(4.0);
        EXPECT_GT(rate, 1.9) << static_cast<int>(e);
    }
}

TEST(MeshCurvature, ConvergesOnIrregularMeshesWithExactNormals) {
    double last = std::numeric_limits<double>::infinity();
    for (const int level : {3, 4, 5}) {
        const Surface s = ellipsoid(1, 0.8, 0.6, level, {.jitter = 0.25, .noise = 0, .seed = 5});
        const double error = support::rmse(density(s), s.density);
        EXPECT_LT(error, 0.7 * last) << level;
        last = error;
    }
}

TEST(MeshCurvature, TotalApproachesTheIntegral) {
    // The integral of k1² + k2² over a torus is (2πR/r + …): ∫∫ (1/r² + cos²θ/(R + r cosθ)²) r (R + r cosθ) dθ dφ.
    const double major = 1, minor = 0.5;
    double integral = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double theta = 2 * std::numbers::pi * i / steps, w = major + minor * std::cos(theta);
        integral += (1 / (minor * minor) + std::pow(std::cos(theta) / w, 2)) * minor * w;
    }
    integral *= 2 * std::numbers::pi / steps * 2 * std::numbers::pi;
    const Surface s = torus(major, minor, 200, 200);
    EXPECT_NEAR(mesh_curvature(s.vertices, s.faces, s.normals).kappa_sum / integral, 1, 1e-3);
}

TEST(MeshCurvature, InvariantUnderRotation) {
    support::Random random(1);
    const Surface s = bumpy();
    for (int trial = 0; trial < 5; ++trial) {
        const auto matrix = support::random_rotation(random);
        Surface r = s;
        r.vertices = support::times(matrix, s.vertices), r.normals = support::times(matrix, s.normals);
        for (const Estimator e : {Estimator::dirichlet, Estimator::corrected})
            for (const bool exact : {true, false})
                EXPECT_LT(largest_relative_difference(density(r, e, exact), density(s, e, exact)), 1e-10);
    }
}

TEST(MeshCurvature, InvariantUnderTranslationByAMillionDiagonals) {
    // Coordinates rounded to a grid that the far copy can hold too, so that both are the same mesh exactly.
    Surface s = bumpy();
    for (double& v : s.vertices) v = std::round(v * 0x1p26) * 0x1p-26;
    Surface far = s;
    for (std::size_t i = 0; i < far.vertices.size(); ++i) far.vertices[i] += 0x1p21 * static_cast<double>(1 + i % 3);
    for (const Estimator e : {Estimator::dirichlet, Estimator::corrected})
        EXPECT_TRUE(support::same_bits(density(far, e, false), density(s, e, false)));
}

TEST(MeshCurvature, InvariantUnderPermutation) {
    support::Random random(2);
    const Surface s = bumpy();
    std::vector<std::size_t> new_of_old;
    const Surface p = permuted(s, random, new_of_old);
    for (const Estimator e : {Estimator::dirichlet, Estimator::corrected}) {
        const auto a = density(s, e, false), b = density(p, e, false);
        std::vector<double> back(a.size());
        for (std::size_t i = 0; i < a.size(); ++i) back[i] = b[new_of_old[i]];
        EXPECT_LT(largest_relative_difference(back, a), 1e-11);
    }
}

TEST(MeshCurvature, FlippedNormalsAndReversedFacesChangeNothing) {
    const Surface s = bumpy();
    Surface flipped = s, reversed = s;
    for (double& n : flipped.normals) n = -n;
    for (std::size_t f = 0; f < reversed.faces.size(); f += 3) std::swap(reversed.faces[f + 1], reversed.faces[f + 2]);
    EXPECT_TRUE(support::same_bits(density(flipped), density(s)));
    for (const Estimator e : {Estimator::dirichlet, Estimator::corrected}) {
        EXPECT_LT(largest_relative_difference(density(flipped, e), density(s, e)), 1e-12);
        EXPECT_LT(largest_relative_difference(density(reversed, e), density(s, e)), 1e-12);
        EXPECT_LT(largest_relative_difference(density(reversed, e, false), density(s, e, false)), 1e-11);
    }
}

TEST(MeshCurvature, ScalesExactly) {
    const Surface s = bumpy();
    const MeshCurvature one = mesh_curvature(s.vertices, s.faces);
    for (const int power : {-40, -3, 5, 30}) {
        Surface t = s;
        for (double& v : t.vertices) v = std::ldexp(v, power);
        const MeshCurvature scaled = mesh_curvature(t.vertices, t.faces);
        EXPECT_TRUE(support::same_bits(scaled.kappa, one.kappa)) << power;
        for (std::size_t i = 0; i < one.density.size(); ++i)
            ASSERT_EQ(scaled.density[i], std::ldexp(one.density[i], -2 * power)) << power;
    }
}

TEST(MeshCurvature, LengthOfGivenNormalsIsImmaterial) {
    const Surface s = bumpy();
    std::vector<double> longer = s.normals;
    for (std::size_t i = 0; i < longer.size(); ++i) longer[i] *= (i / 3) % 2 ? 0x1p300 : 0x1p-40;
    EXPECT_LT(largest_relative_difference(mesh_curvature(s.vertices, s.faces, longer).density, density(s)), 1e-13);
}

TEST(MeshCurvature, SameBitsForAnyNumberOfThreads) {
    support::Random random(3);
    std::vector<std::size_t> map;
    const Surface ordered = torus(1, 0.5, 300, 200, {.jitter = 0.2, .noise = 0, .seed = 9});
    for (const Surface& s : {ordered, permuted(ordered, random, map)})
        for (const Estimator e : {Estimator::dirichlet, Estimator::corrected}) {
            MeshCurvatureOptions options{.estimator = e, .weights = NormalWeights::max, .run = {1, {}}};
            const MeshCurvature one = mesh_curvature(s.vertices, s.faces, {}, options);
            for (const int threads : {2, 7}) {
                options.run.threads = threads;
                const MeshCurvature many = mesh_curvature(s.vertices, s.faces, {}, options);
                EXPECT_TRUE(support::same_bits(many.normals, one.normals)) << threads;
                EXPECT_TRUE(support::same_bits(many.density, one.density)) << threads;
                EXPECT_TRUE(support::same_bits(many.kappa, one.kappa)) << threads;
                EXPECT_EQ(many.kappa_sum, one.kappa_sum);
            }
        }
}

TEST(MeshCurvature, FusedPassGivesTheSameBits) {
    const Surface s = bumpy();
    const MeshCurvature full = mesh_curvature(s.vertices, s.faces);
    std::vector<double> both(2 * full.density.size()), d;
    vertex_density(s.vertices, s.faces, full.normals, both.data());
    double total = 0, faces = 0;
    for (std::size_t v = 0; v < both.size(); v += 2) d.push_back(both[v]), total += both[v + 1];
    EXPECT_TRUE(support::same_bits(d, full.density));
    for (std::size_t f = 0; f < full.kappa.size(); ++f) faces += full.kappa[f] / full.face_density[f];
    EXPECT_NEAR(total, 3 * faces, 1e-9 * total);
}

TEST(MeshCurvature, UndefinedIsNaNAndCounted) {
    // Two triangles, an isolated vertex, a degenerate triangle, one with a NaN corner and one with an infinite one.
    const double inf = std::numeric_limits<double>::infinity();
    const std::vector<double> vertices = {0, 0, 0, 1, 0, 0,   1, 1, 0, 0, 1, 0, 5, 5, 5, not_a_number,
                                          0, 0, 2, 0, 0, inf, 0, 0};
    const std::vector<std::int32_t> faces = {0, 1, 2, 0, 2, 3, 0, 1, 6, 1, 2, 5, 2, 7, 3, 3, 3, 1};
    const MeshCurvature c = mesh_curvature(vertices, faces);
    EXPECT_EQ(c.degenerate_faces, 2u);  // 0 1 6 on a line, 3 3 1
    EXPECT_EQ(c.undefined_faces, 2u);
    EXPECT_EQ(c.undefined, 4u);  // isolated, NaN, infinite, and vertex 6 of the degenerate face alone
    for (const std::size_t v : {4, 5, 6, 7}) EXPECT_TRUE(std::isnan(c.density[v])) << v;
    for (const std::size_t v : {0, 1, 2, 3}) EXPECT_EQ(c.density[v], 0.0) << v;
    EXPECT_EQ(c.kappa[0], 0.0);
    EXPECT_EQ(c.kappa[2], 0.0);
    EXPECT_TRUE(std::isnan(c.face_density[2]));
    EXPECT_TRUE(std::isnan(c.kappa[3]));
    EXPECT_TRUE(std::isnan(c.kappa[4]));
    EXPECT_TRUE(std::isnan(c.normals[3 * 4]));
    EXPECT_EQ(c.kappa_sum, 0.0);
}

TEST(MeshCurvature, DegenerateTrianglesLeaveTheOthersAlone) {
    const Surface s = bumpy();
    Surface t = s;
    for (const std::int32_t f : {0, 10, 50}) {
        const std::int32_t a = s.faces[3 * f], b = s.faces[3 * f + 1];
        t.faces.insert(t.faces.end(), {a, b, a, b, b, b});
    }
    const MeshCurvature c = mesh_curvature(t.vertices, t.faces);
    EXPECT_EQ(c.degenerate_faces, 6u);
    EXPECT_TRUE(support::same_bits(c.density, mesh_curvature(s.vertices, s.faces).density));
}

TEST(MeshCurvature, EmptyInputs) {
    const MeshCurvature none = mesh_curvature({}, {});
    EXPECT_TRUE(none.density.empty());
    EXPECT_EQ(none.undefined, 0u);
    const std::vector<double> vertices = {0, 0, 0, 1, 0, 0};
    const MeshCurvature isolated = mesh_curvature(vertices, {});
    EXPECT_EQ(isolated.undefined, 2u);
    EXPECT_TRUE(std::isnan(isolated.density[1]));
}

TEST(MeshCurvature, MessagesNameArrayIndexAndValue) {
    const std::vector<double> vertices = {0, 0, 0, 1, 0, 0, 1, 1, 0};
    const auto message = [&](std::vector<std::int32_t> faces, std::vector<double> normals) -> std::string {
        try {
            mesh_curvature(vertices, faces, normals);
        } catch (const std::invalid_argument& e) { return e.what(); }
        return "no error";
    };
    EXPECT_EQ(message({0, 1, 2, 0, 3, 2}, {}), "faces[1][1] = 3 is outside [0, 3)");
    EXPECT_EQ(message({0, 1, -1}, {}), "faces[0][2] = -1 is outside [0, 3)");
    EXPECT_EQ(message({0, 1, 2}, {0, 0, 1}), "normals has 1 entries, but there are 3 vertices");
    // The first bad face is named, however many threads look.
    std::vector<std::int32_t> many(300000, 1);
    many[200001] = 77, many[299999] = 88;
    EXPECT_EQ(message(many, {}), "faces[66667][0] = 77 is outside [0, 3)");
}

TEST(MeshCurvature, ProgressRisesAndCancels) {
    const Surface s = torus(1, 0.5, 400, 200);
    for (const int threads : {1, 2}) {
        double last = 0;
        MeshCurvatureOptions options;
        options.run = {threads, [&](double f) {
                           EXPECT_GE(f, last);
                           last = f;
                           return true;
                       }};
        mesh_curvature(s.vertices, s.faces, {}, options);
        EXPECT_GT(last, 0.5);
        options.run.progress = [](double) { return false; };
        EXPECT_THROW(mesh_curvature(s.vertices, s.faces, {}, options), Cancelled);
    }
}
