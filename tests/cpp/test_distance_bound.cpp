// The bounded Hausdorff distance against closed forms and dense samples.
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

HausdorffInterval bound(const Shape& a, const Shape& b, double tolerance) {
    HausdorffOptions options;
    options.tolerance = tolerance;
    return hausdorff_bound(a.vertices, a.faces, ClosestIndex(b.vertices, b.faces), options);
}

void expect_holds(const HausdorffInterval& found, double truth, double tolerance, const char* what) {
    EXPECT_LE(found.lower, truth) << what;
    EXPECT_GE(found.upper, truth) << what;
    EXPECT_LE(found.upper - found.lower, tolerance) << what;
    EXPECT_TRUE(found.within_tolerance) << what;
}

/// Two triangles over the square [−1, 1]² at a height.
Shape sheet(double height) {
    return {{-1, -1, height, 1, -1, height, 1, 1, height, -1, 1, height}, {0, 1, 2, 0, 2, 3}};
}

}  // namespace

TEST(HausdorffBound, HoldsKnownDistances) {
    for (const double tolerance : {1e-1, 1e-3, 1e-6, 1e-9}) {
        expect_holds(bound(sheet(0.5), sheet(0), tolerance), 0.5, tolerance, "parallel sheets");
        // The farthest point from two points is a corner, from four points about it the middle.
        const Shape two{{1, 1, 0, -1, -1, 0}, {}}, four{{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0}, {}};
        expect_holds(bound(sheet(0), two, tolerance), 2, tolerance, "two points");
        expect_holds(bound(sheet(0), four, tolerance), 1, tolerance, "four points, in the middle and at the corners");
        // From a roof over a floor: below its ridge both slopes are equally far.
        const Shape roof{{-1, -1, 0, 0, -1, 1, 1, -1, 0, -1, 1, 0, 0, 1, 1, 1, 1, 0},
                         {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}};
        expect_holds(bound(sheet(0), roof, tolerance), std::sqrt(0.5), tolerance, "under a roof");
        expect_holds(bound(roof, sheet(0), tolerance), 1, tolerance, "over a floor");
    }
}

TEST(HausdorffBound, TellsWhereItIs) {
    const Shape roof{{-1, -1, 0, 0, -1, 1, 1, -1, 0, -1, 1, 0, 0, 1, 1, 1, 1, 0}, {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}};
    const HausdorffInterval found = bound(sheet(0), roof, 1e-6);
    EXPECT_NEAR(found.at[0], 0, 1e-5);
    EXPECT_NEAR(found.at[2], 0, 0);
    EXPECT_NEAR(static_cast<double>(roof.distance(found.at)), found.lower, 1e-12);
}

/// Of soups of triangles the truth lies between the maximum over a fine grid and the same plus the grid's reach.
TEST(HausdorffBound, HoldsTheTruthOfSoups) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Shape a{random_points(12, seed), {}}, b{random_points(60, seed + 100), {}};
        for (std::int32_t i = 0; i < 12; ++i) a.faces.push_back(i);
        if (seed % 2)
            for (std::int32_t i = 0; i < 60; ++i) b.faces.push_back(i);
        const HausdorffInterval found = bound(a, b, 1e-5);
        double sampled = 0;
        const int n = 40;
        for (std::size_t f = 0; f < a.faces.size(); f += 3)
            for (int i = 0; i <= n; ++i)
                for (int j = 0; i + j <= n; ++j) {
                    double p[3];
                    for (int d = 0; d < 3; ++d)
                        p[d] = (i * a.vertices[3 * f + d] + j * a.vertices[3 * f + 3 + d] +
                                (n - i - j) * a.vertices[3 * f + 6 + d]) /
                               n;
                    sampled = std::max(sampled, static_cast<double>(b.distance(p)));
                }
        EXPECT_GE(found.upper, sampled) << seed;
        EXPECT_LE(found.lower, sampled + std::sqrt(3.0) / n) << seed;
        EXPECT_LE(found.upper - found.lower, 1e-5) << seed;
    }
}

TEST(HausdorffBound, NothingIsFarFromItself) {
    const Shape knot = shape_of(torus_knot(2, 3, 2, 1, 0.25, 200, 20));
    HausdorffInterval found = bound(knot, knot, 1e-9);
    EXPECT_EQ(found.lower, 0);
    EXPECT_LE(found.upper, 1e-9);
    EXPECT_LE(found.queries, 4 * (knot.vertices.size() + knot.faces.size()) / 3);
    // Subdivided in its own planes it is the same set.
    Shape fine;
    for (std::size_t f = 0; f < knot.faces.size(); f += 3) {
        const auto first = static_cast<std::int32_t>(fine.vertices.size() / 3);
        const auto corner = [&](int c) { return &knot.vertices[3 * static_cast<std::size_t>(knot.faces[f + c % 3])]; };
        for (int c = 0; c < 3; ++c) fine.vertices.insert(fine.vertices.end(), corner(c), corner(c) + 3);
        for (int c = 0; c < 3; ++c)
            for (int d = 0; d < 3; ++d) fine.vertices.push_back(0.5 * (corner(c)[d] + corner(c + 1)[d]));
        for (const int i : {0, 3, 5, 1, 4, 3, 2, 5, 4, 3, 4, 5}) fine.faces.push_back(first + i);
    }
    found = bound(knot, fine, 1e-2);
    EXPECT_TRUE(found.within_tolerance);
    EXPECT_LE(found.upper, 1e-2);
    found = bound(fine, knot, 1e-9);
    EXPECT_LE(found.upper, 1e-9);
}

/// The promise of samples: never above the upper bound, and close to it.
TEST(HausdorffBound, AgreesWithSamples) {
    const Shape a = shape_of(bumpy_sphere(1, 0.1, 4, 5)), b = shape_of(bumpy_sphere(1, 0.1, 4, 3));
    const SurfaceDistance sampled = surface_distance(a.vertices, a.faces, b.vertices, b.faces, {100000, 0, {}});
    const HausdorffInterval forward = bound(a, b, 1e-5), backward = bound(b, a, 1e-5);
    EXPECT_GE(forward.upper, sampled.forward.max);
    EXPECT_NEAR(forward.lower, sampled.forward.max, 1e-3 * sampled.forward.max + 1e-5);
    EXPECT_GE(backward.upper, sampled.backward.max);
    EXPECT_NEAR(backward.lower, sampled.backward.max, 1e-3 * sampled.backward.max + 1e-5);
}

TEST(HausdorffBound, StopsOnceTheLimitIsDecided) {
    const Shape a = shape_of(torus(1, 0.4, 60, 30)), b = shape_of(torus(1, 0.4, 31, 17));
    const ClosestIndex index(b.vertices, b.faces);
    HausdorffOptions options;
    options.tolerance = 1e-7;
    const HausdorffInterval whole = hausdorff_bound(a.vertices, a.faces, index, options);
    options.limit = 0.5 * whole.lower;
    const HausdorffInterval above = hausdorff_bound(a.vertices, a.faces, index, options);
    EXPECT_GT(above.lower, options.limit);
    EXPECT_LT(above.queries, whole.queries);
    options.limit = 1.5 * whole.upper;
    const HausdorffInterval below = hausdorff_bound(a.vertices, a.faces, index, options);
    EXPECT_LE(below.upper, options.limit);
    EXPECT_LT(below.queries, whole.queries);
    EXPECT_TRUE(above.within_tolerance && below.within_tolerance);
}

TEST(HausdorffBound, SaysWhereItGaveUp) {
    const Shape a = shape_of(torus(1, 0.4, 31, 17)), b = shape_of(torus(1, 0.4, 30, 19));
    HausdorffOptions options;
    options.tolerance = 1e-12;
    options.most_queries = 3000;
    const ClosestIndex index(b.vertices, b.faces);
    const HausdorffInterval found = hausdorff_bound(a.vertices, a.faces, index, options);
    EXPECT_FALSE(found.within_tolerance);
    const HausdorffInterval better = bound(a, b, 1e-5);
    EXPECT_LE(found.lower, better.upper);
    EXPECT_GE(found.upper, better.lower);
    EXPECT_EQ(refusal([&] {
                  hausdorff_bound(a.vertices, a.faces, index, {-1, -1, 10, {}});
              }),
              "hausdorff_bound: tolerance = -1 must be finite and not negative");
    EXPECT_EQ(refusal([&] { hausdorff_bound(Points(), {}, index); }),
              "vertices is empty; a surface or a cloud needs some");
    options.run.progress = [](double) { return false; };
    EXPECT_THROW(hausdorff_bound(a.vertices, a.faces, index, options), Cancelled);
}

TEST(HausdorffBound, CloudsAndDegenerateFaces) {
    const Shape cloud{random_points(200, 1), {}}, ball = shape_of(sphere(3));
    const HausdorffInterval found = bound(cloud, ball, 1e-9);
    double truth = 0;
    for (std::size_t i = 0; i < 200; ++i)
        truth = std::max(truth, static_cast<double>(ball.distance(&cloud.vertices[3 * i])));
    expect_holds(found, truth, 1e-9, "a cloud");
    EXPECT_EQ(found.queries, 200u);
    // A segment as a face: its middle is the farthest.
    const Shape segment{{-1, 0, 0, 1, 0, 0, 1, 0, 0}, {0, 1, 2}}, ends{{-1, 0, 0, 1, 0, 0}, {}};
    expect_holds(bound(segment, ends, 1e-9), 1, 1e-9, "a segment");
}
