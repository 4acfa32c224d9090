// Closest points against their definition, and the distances made of them against closed forms and invariances.
#include "gaussmap/distance.h"

#include "../../src/closest_tree.h"
#include "clouds.h"
#include "distance_reference.h"
#include "gaussmap/surfaces.h"
#include "nearest_reference.h"

using namespace gaussmap;
using support::Random;
using support::random_points;
using support::refusal;
using support::Shape;
using support::shape_of;

namespace {

/// Triangles of all sizes and shapes at random: needles, slivers, segments and points among them.
Shape soup(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    Shape shape;
    for (std::size_t f = 0; f < count; ++f) {
        double a[3], b[3], c[3];
        const double size = std::pow(10.0, -4 * random.uniform()), thin = std::pow(10.0, -16 * random.uniform());
        for (int d = 0; d < 3; ++d) {
            a[d] = random.uniform();
            b[d] = a[d] + size * (random.uniform() - 0.5);
            c[d] = a[d] + size * (random.uniform() - 0.5);
        }
        const double t = 2 * random.uniform() - 0.5;
        for (int d = 0; d < 3; ++d) switch (f % 5) {
                case 1:
                    c[d] = a[d] + t * (b[d] - a[d]) + thin * (c[d] - a[d]);
                    break;  // needle
                case 2:
                    c[d] = a[d] + t * (b[d] - a[d]);
                    break;  // segment
                case 3:
                    c[d] = f % 2 ? a[d] : b[d];
                    break;  // segment, repeated corner
                case 4:
                    f % 3 == 0 ? void(b[d] = c[d] = a[d]) : void();
                    break;  // point
                default:
                    break;
            }
        for (const double* p : {a, b, c}) shape.vertices.insert(shape.vertices.end(), p, p + 3);
        for (int i = 0; i < 3; ++i)
            shape.faces.push_back(static_cast<std::int32_t>(3 * f) + (i + static_cast<int>(f)) % 3);
    }
    return shape;
}

void expect_closest(const Shape& shape, const std::vector<double>& queries, const char* what) {
    const ClosestPoints found = ClosestIndex(shape.vertices, shape.faces).closest(queries);
    ASSERT_EQ(found.distance.size(), queries.size() / 3);
    for (std::size_t i = 0; i < found.distance.size(); ++i) {
        const double* q = &queries[3 * i];
        const auto truth = static_cast<double>(shape.distance(q));
        ASSERT_NEAR(found.distance[i], truth, 1e-13 * (1 + truth)) << what << ", query " << i;
        const double* p = &found.points[3 * i];
        ASSERT_NEAR(std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]), truth, 1e-13 * (1 + truth)) << what;
        const auto element = static_cast<std::size_t>(found.element[i]);
        Shape alone{shape.vertices, {}};
        if (shape.faces.empty())
            alone.vertices.assign(&shape.vertices[3 * element], &shape.vertices[3 * element] + 3);
        else
            alone.faces.assign(&shape.faces[3 * element], &shape.faces[3 * element] + 3);
        ASSERT_NEAR(static_cast<double>(alone.distance(p)), 0, 1e-13 * (1 + truth)) << what << ", element " << element;
        ASSERT_NEAR(static_cast<double>(alone.distance(q)), truth, 1e-13 * (1 + truth)) << what;
    }
}

Shape square(double height, double side = 1) {
    return {{0, 0, height, side, 0, height, side, side, height, 0, side, height}, {0, 1, 2, 0, 2, 3}};
}

}  // namespace

TEST(ClosestIndex, AsTheDefinitionSays) {
    const Shape bumpy = shape_of(bumpy_sphere(1, 0.2, 4, 3, {0.25, 0, 1}));
    std::vector<double> queries = random_points(150, 2, 2.6), far = random_points(50, 3, 200);
    for (double& v : queries) v -= 1.3;
    for (double& v : far) v -= 100;
    expect_closest(bumpy, queries, "around a bumpy sphere");
    expect_closest(bumpy, far, "far from it");
    const std::vector<double> own(bumpy.vertices.begin(), bumpy.vertices.begin() + 3 * 200);
    expect_closest(bumpy, own, "its own vertices");
    expect_closest({bumpy.vertices, {}}, queries, "a cloud");
}

TEST(ClosestIndex, TrianglesOfAnyShape) {
    const Shape shape = soup(600, 4);
    expect_closest(shape, random_points(300, 5), "among them");
    std::vector<double> corners = shape.vertices;
    corners.resize(3 * 200);
    expect_closest(shape, corners, "their corners");
    Random random(6);
    for (double& v : corners) v += 1e-9 * random.normal();
    expect_closest(shape, corners, "next to their corners");
}

TEST(ClosestIndex, EveryCountOfTriangles) {
    for (const std::size_t n : {1, 2, 3, 4, 5, 31, 32, 33, 255, 256, 257, 2049})
        expect_closest(soup(n, n), random_points(20, 100 + n), "few");
    const Shape few = soup(3, 1);
    EXPECT_TRUE(ClosestIndex(few.vertices).distances(Points()).empty());
}

TEST(ClosestIndex, KernelsAgreeToTheBit) {
    const Shape shape = soup(3000, 7);
    const std::vector<double> queries = random_points(3000, 8);
    const ClosestFaces baseline = closest_faces(shape.vertices, shape.faces, queries, closest_kernel_baseline);
#ifdef __x86_64__
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2 here";
    const ClosestFaces avx2 = closest_faces(shape.vertices, shape.faces, queries, closest_kernel_avx2);
    EXPECT_TRUE(support::same_bits(baseline.squared, avx2.squared));
    EXPECT_EQ(baseline.face, avx2.face);
#endif
}

TEST(ClosestIndex, OfEquallyCloseFacesTheFirst) {
    Shape twice = square(0);
    const std::vector<std::int32_t> once = twice.faces;
    for (int i = 0; i < 40; ++i) twice.faces.insert(twice.faces.end(), once.begin(), once.end());
    const std::vector<double> above = {0.7, 0.2, 1, 0.2, 0.7, 1, 2, 0.5, 0};
    const ClosestPoints found = ClosestIndex(twice.vertices, twice.faces).closest(above);
    EXPECT_EQ(found.element, (std::vector<std::int32_t>{0, 1, 0}));
}

TEST(ClosestIndex, SaysWhatItRefuses) {
    const Shape shape = square(0);
    std::vector<double> bad = shape.vertices;
    bad[7] = NAN;
    EXPECT_EQ(refusal([&] { ClosestIndex(bad, shape.faces); }),
              "vertices[2], of faces[0], is not finite; leave it out first");
    EXPECT_EQ(refusal([&] { ClosestIndex index(bad); }), "vertices[2] is not finite; leave it out first");
    EXPECT_EQ(refusal([&] { ClosestIndex index{Points()}; }), "vertices is empty; a surface or a cloud needs some");
    const std::vector<std::int32_t> outside = {0, 1, 4};
    EXPECT_EQ(refusal([&] { ClosestIndex(shape.vertices, outside); }), "faces[0][2] = 4 is outside [0, 4)");
    const ClosestIndex index(shape.vertices, shape.faces);
    EXPECT_EQ(refusal([&] { index.distances(bad); }), "queries[2] is not finite; leave such points out first");
    // A vertex of no face may be anything.
    bad.assign({0, 0, 0, 1, 0, 0, 0, 1, 0, NAN, 0, 0});
    const std::vector<std::int32_t> one = {0, 1, 2};
    const std::vector<double> above = {0, 0, 3};
    EXPECT_DOUBLE_EQ(ClosestIndex(bad, one).distances(above)[0], 3);
}

TEST(SurfaceDistance, ParallelSquares) {
    const Shape a = square(0), b = square(0.25);
    const SurfaceDistance found = surface_distance(a.vertices, a.faces, b.vertices, b.faces, {1000, 0, {}});
    for (const Deviation& way : {found.forward, found.backward, found.symmetric}) {
        EXPECT_NEAR(way.max, 0.25, 1e-15);
        EXPECT_NEAR(way.rms, 0.25, 1e-15);
        EXPECT_NEAR(way.mean, 0.25, 1e-15);
    }
    EXPECT_EQ(found.forward_samples.vertices, 4u);
    EXPECT_EQ(found.forward_samples.edges, 250u);
    EXPECT_EQ(found.forward_samples.faces, 1000u);
    EXPECT_DOUBLE_EQ(found.diagonal, std::sqrt(2.0));
}

/// A small square in a large one: nothing there, a closed form back.
TEST(SurfaceDistance, OneSidedDiffers) {
    const Shape small = square(0), large = square(0, 2);
    const SurfaceDistance found = surface_distance(small.vertices, small.faces, large.vertices, large.faces);
    EXPECT_NEAR(found.forward.max, 0, 1e-15);
    EXPECT_NEAR(found.backward.max, std::sqrt(2.0), 1e-15);
    // ∫ over [0, 2]² of (x − 1)₊² + (y − 1)₊² is 4/3, of an area of 4.
    EXPECT_NEAR(found.backward.rms, std::sqrt(1.0 / 3), 5e-5);
    // ∫ x over two unit squares is 1; ∫ √(x² + y²) over one is (√2 + asinh 1)/3.
    EXPECT_NEAR(found.backward.mean, (1 + (std::sqrt(2.0) + std::asinh(1.0)) / 3) / 4, 5e-5);
    EXPECT_EQ(found.symmetric.max, found.backward.max);
}

/// An inscribed icosphere: its distance from the sphere is known at each of its points.
TEST(SurfaceDistance, InscribedSpheres) {
    const Shape coarse = shape_of(sphere(2)), fine = shape_of(sphere(6));
    const SurfaceDistance found =
        surface_distance(coarse.vertices, coarse.faces, fine.vertices, fine.faces, {100000, 0, {}});
    double max = 0;
    for (std::size_t f = 0; f < coarse.faces.size(); f += 3) {
        double middle[3] = {0, 0, 0};
        for (int c = 0; c < 3; ++c)
            for (int d = 0; d < 3; ++d) middle[d] += coarse.vertices[3 * coarse.faces[f + c] + d] / 3;
        max = std::max(max, 1 - std::hypot(middle[0], middle[1], middle[2]));
    }
    EXPECT_NEAR(found.forward.max, max, 3e-4 * max + 1e-4);
    EXPECT_NEAR(found.backward.max, max, 3e-4 * max + 1e-4);
    EXPECT_NEAR(found.forward.rms, found.backward.rms, 2e-4);
}

TEST(SurfaceDistance, CloudsAreTheirPoints) {
    const std::vector<double> a = random_points(300, 1), b = random_points(200, 2);
    const SurfaceDistance found = surface_distance(a, {}, b, {});
    double max = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < 300; ++i) {
        const auto d = static_cast<double>(Shape{b, {}}.distance(&a[3 * i]));
        max = std::max(max, d), sum += d, squares += d * d;
    }
    EXPECT_DOUBLE_EQ(found.forward.max, max);
    EXPECT_NEAR(found.forward.mean, sum / 300, 1e-14);
    EXPECT_NEAR(found.forward.rms, std::sqrt(squares / 300), 1e-14);
    EXPECT_EQ(found.forward_samples.vertices, 300u);
    EXPECT_EQ(found.backward_samples.vertices, 200u);
    EXPECT_EQ(found.forward_samples.faces + found.forward_samples.edges, 0u);
    const Shape ball = shape_of(sphere(4));
    const SurfaceDistance own = surface_distance(ball.vertices, {}, ball.vertices, ball.faces, {2000, 0, {}});
    EXPECT_EQ(own.forward.max, 0);
    EXPECT_GT(own.backward.max, 0.01);
}

TEST(SurfaceDistance, FollowsMotionAndUnit) {
    const Shape a = shape_of(torus(1, 0.4, 40, 20)), b = shape_of(torus(1, 0.38, 17, 11));
    const DistanceOptions options{20000, 3, {}};
    const SurfaceDistance still = surface_distance(a.vertices, a.faces, b.vertices, b.faces, options);
    Random random(5);
    const std::vector<double> turn = support::random_rotation(random);
    const auto moved = [&](const Shape& s, double scale, double shift) {
        std::vector<double> out = support::times(turn, s.vertices);
        for (double& v : out) v = scale * v + shift;
        return out;
    };
    struct Motion {
        double scale, shift, precision;
    };
    for (const Motion& motion : {Motion{1, 0, 1e-13}, {1e-20, 0, 1e-13}, {1e20, 0, 1e-13}, {1, 1e7, 1e-7}}) {
        const double scale = motion.scale, precision = motion.precision;
        const std::vector<double> moved_a = moved(a, scale, motion.shift), moved_b = moved(b, scale, motion.shift);
        const SurfaceDistance now = surface_distance(moved_a, a.faces, moved_b, b.faces, options);
        const auto expect = [&](const Deviation& x, const Deviation& y) {
            EXPECT_NEAR(x.max / scale, y.max, precision);
            EXPECT_NEAR(x.rms / scale, y.rms, precision);
            EXPECT_NEAR(x.mean / scale, y.mean, precision);
        };
        expect(now.forward, still.forward);
        expect(now.backward, still.backward);
        const auto ends = hausdorff_bound(moved_a, a.faces, ClosestIndex(moved_b, b.faces));
        EXPECT_LE(ends.lower, now.forward.max * (1 + 1e-3));
        EXPECT_GE(ends.upper, now.forward.max);
    }
}

TEST(SurfaceDistance, SameBitsForAnyNumberOfThreads) {
    const Shape a = shape_of(bumpy_sphere(1, 0.2, 4, 4)), b = shape_of(sphere(3));
    const std::vector<double> queries = random_points(5000, 9);
    const auto run = [&](int threads) {
        const SurfaceDistance d = surface_distance(a.vertices, a.faces, b.vertices, b.faces, {50000, 1, {threads, {}}});
        const ClosestIndex index(b.vertices, b.faces, {threads, {}});
        const HausdorffInterval h = hausdorff_bound(a.vertices, a.faces, index, {1e-5, -1, 1 << 20, {threads, {}}});
        std::vector<double> all = {d.forward.max,   d.forward.rms, d.forward.mean, d.backward.max, d.backward.rms,
                                   d.backward.mean, h.lower,       h.upper,        h.at[0],        double(h.queries)};
        const std::vector<double> each = index.distances(queries);
        all.insert(all.end(), each.begin(), each.end());
        return all;
    };
    const std::vector<double> one = run(1);
    for (const int threads : {2, 3, 8}) EXPECT_TRUE(support::same_bits(one, run(threads))) << threads;
}

TEST(SurfaceDistance, DegenerateSurfaces) {
    // A segment as a face, and a point as one: edges and vertices stand in for the area.
    const std::vector<double> line = {0, 0, 0, 2, 0, 0, 1, 0, 0}, point = {0, 0, 1};
    const std::vector<std::int32_t> face = {0, 1, 2}, nothing = {0, 0, 0};
    const SurfaceDistance found = surface_distance(line, face, point, nothing);
    EXPECT_DOUBLE_EQ(found.forward.max, std::sqrt(5.0));
    EXPECT_NEAR(found.forward.rms, std::sqrt(1 + 4.0 / 3), 1e-4);
    EXPECT_DOUBLE_EQ(found.backward.max, 1);
    EXPECT_DOUBLE_EQ(found.backward.mean, 1);
    EXPECT_EQ(found.forward_samples.faces, 0u);
}

TEST(SurfaceDistance, SaysWhichOneItRefuses) {
    const Shape a = square(0);
    std::vector<double> bad = a.vertices;
    bad[0] = INFINITY;
    EXPECT_EQ(refusal([&] { surface_distance(a.vertices, a.faces, bad, a.faces); }),
              "b: vertices[0], of faces[0], is not finite; leave it out first");
    EXPECT_EQ(refusal([&] { surface_distance(Points(), {}, a.vertices, a.faces); }),
              "a: vertices is empty; a surface or a cloud needs some");
}

TEST(SurfaceDistance, CanBeCancelled) {
    const Shape a = shape_of(sphere(4));
    DistanceOptions options;
    options.run.progress = [](double done) { return done < 0.3; };
    EXPECT_THROW(surface_distance(a.vertices, a.faces, a.vertices, a.faces, options), Cancelled);
}
