// Points on surfaces: where they lie, how evenly, and what they carry.
#include "gaussmap/sampling.h"

#include <algorithm>
#include <numeric>

#include "clouds.h"
#include "gaussmap/distance.h"
#include "gaussmap/neighbors.h"
#include "gaussmap/surfaces.h"
#include "nearest_reference.h"
#include "support.h"

using namespace gaussmap;
using support::refusal;

namespace {

constexpr SamplingMethod methods[] = {SamplingMethod::random, SamplingMethod::poisson, SamplingMethod::nonuniform};

struct Mesh {
    std::vector<double> vertices;
    std::vector<std::int32_t> faces;
};

SurfacePoints sample(const Mesh& mesh, std::size_t count, SamplingMethod method, std::uint64_t seed = 0,
                     int threads = 0) {
    return sample_surface(mesh.vertices, mesh.faces, count, {method, seed, {threads, {}}});
}

Mesh mesh_of(const Surface& surface) {
    return {surface.vertices, surface.faces};
}

/// Triangles between three corners, whose areas are as 1 : 2 : 3 : …, one beside the other.
Mesh strip(std::size_t count) {
    Mesh mesh;
    for (std::size_t f = 0; f < count; ++f) {
        const double x = 2 * static_cast<double>(f), h = static_cast<double>(f + 1);
        mesh.vertices.insert(mesh.vertices.end(), {x, 0, 0, x + 1, 0, 0, x, h, 0});
        for (int c = 0; c < 3; ++c) mesh.faces.push_back(static_cast<std::int32_t>(3 * f) + c);
    }
    return mesh;
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); f += 3) {
        double e[2][3];
        for (int s = 0; s < 2; ++s)
            for (int d = 0; d < 3; ++d)
                e[s][d] = mesh.vertices[3 * mesh.faces[f + s + 1] + d] - mesh.vertices[3 * mesh.faces[f] + d];
        sum += 0.5 * std::hypot(e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                                e[0][0] * e[1][1] - e[0][1] * e[1][0]);
    }
    return sum;
}

/// Distance of each point to its nearest neighbour, over that of the densest packing of as many disks.
std::vector<double> spacing(const SurfacePoints& points, double area) {
    const double densest = std::sqrt(2 * area / (std::numbers::sqrt3 * static_cast<double>(points.count())));
    const NearestPoints near = NeighborIndex(points.points).nearest(points.points, 2, true);
    std::vector<double> ratio;
    for (std::size_t i = 1; i < near.squared_distance.size(); i += 2)
        ratio.push_back(std::sqrt(near.squared_distance[i]) / densest);
    return ratio;
}

}  // namespace

TEST(SampleSurface, GivesTheCountOnTheSurface) {
    const Mesh knot = mesh_of(torus_knot(2, 3, 2, 1, 0.25, 100, 12, {0.25, 0, 1}));
    const ClosestIndex index(knot.vertices, knot.faces);
    for (const SamplingMethod method : methods)
        for (const std::size_t count : {1, 2, 10, 1000, 4001}) {
            const SurfacePoints points = sample(knot, count, method, 3);
            ASSERT_EQ(points.count(), count);
            ASSERT_EQ(points.points.size(), 3 * count);
            for (const double d : index.distances(points.points)) ASSERT_LT(d, 1e-14);
            for (std::size_t i = 0; i < count; ++i) {
                const double* w = &points.weights[3 * i];
                ASSERT_GE(std::min({w[0], w[1], w[2]}), -1e-16);
                ASSERT_NEAR(w[0] + w[1] + w[2], 1, 1e-15);
                for (int d = 0; d < 3; ++d) {
                    double sum = 0;
                    for (int c = 0; c < 3; ++c) sum += w[c] * knot.vertices[3 * knot.faces[3 * points.face[i] + c] + d];
                    ASSERT_NEAR(points.points[3 * i + d], sum, 1e-14);
                }
            }
        }
}

/// Points that are stored in a plane stay in it to the last bit.
TEST(SampleSurface, StaysInThePlaneOfATriangle) {
    const Mesh mesh{{0, 0, 0.1, 1, 0, 0.1, 0, 1, 0.1}, {0, 1, 2}};
    for (const SamplingMethod method : methods)
        for (std::size_t i = 0; const double v : sample(mesh, 500, method).points) {
            if (i++ % 3 == 2) { EXPECT_EQ(v, 0.1); }
            EXPECT_GE(v, 0);
            EXPECT_LE(v, 1);
        }
}

/// Chi-square of the counts on triangles of very different areas: 49 degrees of freedom, the 99.99 % quantile is 96.
TEST(SampleSurface, IsUniformByArea) {
    const Mesh mesh = strip(50);
    const double total = area(mesh);
    for (const SamplingMethod method : methods)
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
            const std::size_t count = 10000;
            const SurfacePoints points = sample(mesh, count, method, seed);
            std::vector<double> counts(50);
            for (const std::int32_t f : points.face) ++counts[static_cast<std::size_t>(f)];
            double chi = 0;
            for (std::size_t f = 0; f < 50; ++f) {
                const double expected = static_cast<double>(count) * 0.5 * static_cast<double>(f + 1) / total;
                chi += (counts[f] - expected) * (counts[f] - expected) / expected;
            }
            EXPECT_LT(chi, 96) << static_cast<int>(method);
            // Random points are no more even than chance: the 0.01 % quantile is 19.
            EXPECT_EQ(chi < 17, method == SamplingMethod::poisson) << chi;
        }
}

/// And uniform within a triangle: the mean of each weight is 1/3, of its square 1/6.
TEST(SampleSurface, IsUniformWithinATriangle) {
    const Mesh mesh{{0, 0, 0, 3, 0, 0, 1, 0.5, 2}, {0, 1, 2}};
    for (const SamplingMethod method : methods) {
        const SurfacePoints points = sample(mesh, 15000, method, 5);
        for (int c = 0; c < 3; ++c) {
            double sum = 0, squares = 0;
            for (std::size_t i = 0; i < points.count(); ++i) {
                const double w = points.weights[3 * i + static_cast<std::size_t>(c)];
                sum += w, squares += w * w;
            }
            EXPECT_NEAR(sum / 15000, 1.0 / 3, 0.008);
            EXPECT_NEAR(squares / 15000, 1.0 / 6, 0.008);
        }
    }
}

TEST(SampleSurface, PoissonKeepsItsDistance) {
    for (const Mesh& mesh : {mesh_of(sphere(4)), mesh_of(torus(1, 0.5, 60, 30)), mesh_of(plane(1, 2, 4, 4))})
        for (const std::size_t count : {500, 5000}) {
            const double size = area(mesh);
            std::vector<double> poisson = spacing(sample(mesh, count, SamplingMethod::poisson, 1), size);
            EXPECT_GT(*std::min_element(poisson.begin(), poisson.end()), 0.6);
            const double mean = std::accumulate(poisson.begin(), poisson.end(), 0.0) / static_cast<double>(count);
            EXPECT_GT(mean, 0.74);
            // The half of a Poisson sample has close pairs, but none closer than those of the whole.
            std::vector<double> half = spacing(sample(mesh, count, SamplingMethod::nonuniform, 1), size);
            EXPECT_GT(*std::min_element(half.begin(), half.end()), 0.6 / std::numbers::sqrt2);
            EXPECT_LT(*std::min_element(half.begin(), half.end()), 0.57);
            std::vector<double> random = spacing(sample(mesh, count, SamplingMethod::random, 1), size);
            EXPECT_LT(*std::min_element(random.begin(), random.end()), 0.1);
        }
}

TEST(SampleSurface, SameBitsForAnyNumberOfThreads) {
    const Mesh mesh = mesh_of(bumpy_sphere(1, 0.2, 4, 4));
    for (const SamplingMethod method : methods) {
        const SurfacePoints one = sample(mesh, 3000, method, 7, 1);
        for (const int threads : {2, 3, 7}) {
            const SurfacePoints many = sample(mesh, 3000, method, 7, threads);
            EXPECT_TRUE(support::same_bits(one.points, many.points));
            EXPECT_EQ(one.face, many.face);
        }
        EXPECT_FALSE(support::same_bits(one.points, sample(mesh, 3000, method, 8).points));
    }
}

TEST(SampleSurface, FollowsTheUnit) {
    Mesh mesh = mesh_of(torus(1, 0.5, 30, 20));
    const SurfacePoints before = sample(mesh, 800, SamplingMethod::poisson, 2);
    for (double& v : mesh.vertices) v *= 0x1p70;
    const SurfacePoints after = sample(mesh, 800, SamplingMethod::poisson, 2);
    EXPECT_EQ(before.face, after.face);
    EXPECT_TRUE(support::same_bits(before.weights, after.weights));
}

TEST(SampleSurface, LeavesOutWhatHasNoArea) {
    const Mesh mesh{{0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 5, 5, 5}, {0, 1, 3, 4, 4, 4, 0, 1, 2, 1, 1, 3}};
    for (const SamplingMethod method : methods)
        for (const std::int32_t f : sample(mesh, 300, method).face) EXPECT_EQ(f, 2);
}

TEST(SampleSurface, SaysWhatItRefuses) {
    const Mesh mesh{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}};
    EXPECT_EQ(refusal([&] { sample(mesh, 0, SamplingMethod::random); }),
              "sample_surface: count = 0 must be from 1 to 134217728");
    EXPECT_EQ(refusal([&] {
                  sample({mesh.vertices, {}}, 5, SamplingMethod::random);
              }),
              "faces is empty; only a surface can be sampled");
    EXPECT_EQ(refusal([&] {
                  sample({mesh.vertices, {0, 1, 3}}, 5, SamplingMethod::random);
              }),
              "faces[0][2] = 3 is outside [0, 3)");
    EXPECT_EQ(refusal([&] {
                  sample({mesh.vertices, {0, 1, 1}}, 5, SamplingMethod::random);
              }),
              "faces have no area; there is nothing to sample");
    EXPECT_EQ(refusal([&] {
                  sample({{0, 0, 0, 1, NAN, 0, 0, 1, 0}, {0, 1, 2}}, 5, SamplingMethod::random);
              }),
              "vertices[1], of faces[0], is not finite; leave it out first");
    EXPECT_EQ(refusal([&] {
                  sample({{0, 0, 0, 1e200, 0, 0, 0, 1e200, 0}, {0, 1, 2}}, 5, SamplingMethod::random);
              }),
              "faces have an area that is too large to be computed; use another unit");
    SamplingOptions options;
    options.run.progress = [](double done) { return done < 0.5; };
    EXPECT_THROW(sample_surface(mesh.vertices, mesh.faces, 10000, options), Cancelled);
}

TEST(Interpolate, IsLinear) {
    const Mesh mesh = mesh_of(torus(1, 0.5, 20, 10));
    const SurfacePoints at = sample(mesh, 500, SamplingMethod::random, 4);
    std::vector<double> values, pairs;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
        values.push_back(3 * mesh.vertices[i] - mesh.vertices[i + 2] + 7);
        pairs.insert(pairs.end(), {mesh.vertices[i + 1], 5.0});
    }
    const std::vector<double> one = interpolate(at, mesh.faces, values), two = interpolate(at, mesh.faces, pairs, 2);
    for (std::size_t i = 0; i < at.count(); ++i) {
        EXPECT_NEAR(one[i], 3 * at.points[3 * i] - at.points[3 * i + 2] + 7, 1e-13);
        EXPECT_NEAR(two[2 * i], at.points[3 * i + 1], 1e-13);
        EXPECT_NEAR(two[2 * i + 1], 5, 1e-13);
    }
    values.resize(10);
    EXPECT_NE(refusal([&] { interpolate(at, mesh.faces, values); }).find("values has 10 entries, none for vertex"),
              std::string::npos);
}

TEST(Interpolate, NormalsAreUnit) {
    const Surface ball = sphere(3);
    const SurfacePoints at = sample_surface(ball.vertices, ball.faces, 500, {SamplingMethod::random, 1, {}});
    const std::vector<double> normals = interpolate_normals(at, ball.faces, ball.normals);
    for (std::size_t i = 0; i < normals.size(); i += 3) {
        EXPECT_NEAR(std::hypot(normals[i], normals[i + 1], normals[i + 2]), 1, 1e-15);
        const double r = std::hypot(at.points[i], at.points[i + 1], at.points[i + 2]);
        for (int d = 0; d < 3; ++d) EXPECT_NEAR(normals[i + d], at.points[i + d] / r, 1e-15);
    }
}

TEST(PoissonSubset, TakesEvenlyFromAnyPoints) {
    std::vector<double> points = support::random_points(3000, 1);
    for (std::size_t i = 2; i < points.size(); i += 3) points[i] = 0;
    const std::vector<std::int32_t> kept = poisson_subset(points, 1, 400);
    EXPECT_EQ(kept.size(), 400u);
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
    EXPECT_EQ(poisson_subset(points, 1, 5000).size(), 3000u);
    EXPECT_TRUE(poisson_subset(points, 1, 0).empty());
    // Of copies, one.
    std::vector<double> copies;
    for (const std::int32_t k : kept)
        for (int i = 0; i < 4; ++i) copies.insert(copies.end(), &points[3 * k], &points[3 * k] + 3);
    for (std::size_t i = 0; const std::int32_t k : poisson_subset(copies, 1, 400)) EXPECT_EQ(k / 4, std::int32_t(i++));
    EXPECT_EQ(refusal([&] { poisson_subset(points, 0, 5); }), "poisson_subset: area = 0 must be positive and finite");
    points[4] = NAN;
    EXPECT_EQ(refusal([&] { poisson_subset(points, 1, 5); }), "candidates[1] is not finite; leave such points out");
}
