// Vertex normals of meshes.
#include <limits>

#include "gaussmap/normals.h"
#include "gaussmap/surfaces.h"
#include "support.h"

using namespace gaussmap;

namespace {

/// Largest angle, in radians, between two sets of unit vectors.
double largest_angle(const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); i += 3) {
        double chord = 0;
        for (int c = 0; c < 3; ++c) chord += (a[i + c] - b[i + c]) * (a[i + c] - b[i + c]);
        worst = std::max(worst, 2 * std::asin(std::sqrt(chord) / 2));
    }
    return worst;
}

}  // namespace

TEST(MeshNormals, MaxWeightsAreExactOnIrregularSpheres) {
    const Surface s = sphere(4, 2, {.jitter = 0.3, .noise = 0, .seed = 4});
    EXPECT_LT(largest_angle(mesh_normals(s.vertices, s.faces, NormalWeights::max), s.normals), 1e-11);
    EXPECT_GT(largest_angle(mesh_normals(s.vertices, s.faces, NormalWeights::area), s.normals), 1e-4);
    EXPECT_GT(largest_angle(mesh_normals(s.vertices, s.faces, NormalWeights::angle), s.normals), 1e-5);
}

TEST(MeshNormals, AllWeightsAreUnitAndOutward) {
    const Surface s = torus(1, 0.3, 60, 30);
    for (const NormalWeights w : {NormalWeights::max, NormalWeights::angle, NormalWeights::area}) {
        const auto normals = mesh_normals(s.vertices, s.faces, w);
        EXPECT_LT(largest_angle(normals, s.normals), 0.05);
        for (std::size_t i = 0; i < normals.size(); i += 3)
            ASSERT_NEAR(std::hypot(normals[i], normals[i + 1], normals[i + 2]), 1, 1e-15);
    }
}

TEST(MeshNormals, AngleWeightsDoNotSeeTheTriangulation) {
    // A cube's corner, each face one triangle or two: the angle-weighted normal is (1,1,1)/√3 in every case.
    const std::vector<double> v = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1};
    const std::vector<std::int32_t> f = {0, 2, 1, 0, 3, 2, 0, 1, 5, 0, 5, 4, 0, 4, 3, 4, 6, 3};
    const auto n = mesh_normals(v, f, NormalWeights::angle);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(n[c], -1 / std::sqrt(3.0), 1e-15);
}

TEST(MeshNormals, UndefinedIsNaN) {
    const std::vector<double> v = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 9, 9, 9};
    // 0 1 3 and 3 1 0 cancel exactly; 0 1 2 lies on a line; vertex 4 is isolated.
    const std::vector<std::int32_t> f = {0, 1, 3, 3, 1, 0, 0, 1, 2};
    for (const double n : mesh_normals(v, f)) EXPECT_TRUE(std::isnan(n));
}

TEST(MeshNormals, TinyAndLargeMeshes) {
    const Surface s = sphere(2);
    for (const double scale : {1e-45, 1e40}) {
        std::vector<double> v = s.vertices;
        for (double& x : v) x *= scale;
        for (const NormalWeights w : {NormalWeights::max, NormalWeights::angle, NormalWeights::area})
            EXPECT_LT(largest_angle(mesh_normals(v, s.faces, w), mesh_normals(s.vertices, s.faces, w)), 1e-12) << scale;
    }
}

TEST(MeshNormals, SameBitsForAnyNumberOfThreads) {
    const Surface s = torus(1, 0.5, 300, 200, {.jitter = 0.2, .noise = 0, .seed = 9});
    for (const NormalWeights w : {NormalWeights::max, NormalWeights::angle, NormalWeights::area}) {
        const auto one = mesh_normals(s.vertices, s.faces, w, {1, {}});
        EXPECT_TRUE(support::same_bits(mesh_normals(s.vertices, s.faces, w, {2, {}}), one));
        EXPECT_TRUE(support::same_bits(mesh_normals(s.vertices, s.faces, w, {7, {}}), one));
    }
}

TEST(MeshNormals, MessageNamesTheIndex) {
    const std::vector<double> v = {0, 0, 0};
    const std::vector<std::int32_t> f = {0, 0, 1};
    try {
        mesh_normals(v, f);
        FAIL() << "no error";
    } catch (const std::invalid_argument& e) { EXPECT_STREQ(e.what(), "faces[0][2] = 1 is outside [0, 1)"); }
}
