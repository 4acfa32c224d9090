// Decimation of surfaces that are known: what must be kept is kept, by every method.

#include "gaussmap/decimate.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "gaussmap/distance.h"
#include "gaussmap/surfaces.h"
#include "support.h"
#include "validity.h"

namespace {

using gaussmap::decimate;
using gaussmap::DecimateOptions;
using gaussmap::Decimation;
using gaussmap::DecimationMethod;
using gaussmap::DecimationStop;
using gaussmap::Surface;
using validity::counts_of;

struct Way {
    const char* name;
    DecimationMethod method;
    bool weights, fast;
};
constexpr Way ways[] = {{"best", DecimationMethod::best, true, false},
                        {"best, no weights", DecimationMethod::best, false, false},
                        {"fast", DecimationMethod::best, true, true},
                        {"qem", DecimationMethod::qem, true, false},
                        {"qem, no weights", DecimationMethod::qem, false, false},
                        {"edge", DecimationMethod::edge, true, false},
                        {"edge, no weights", DecimationMethod::edge, false, false}};

DecimateOptions to(std::size_t faces, const Way& way = ways[0]) {
    DecimateOptions options;
    options.faces = faces;
    options.method = way.method;
    options.weights = way.weights;
    options.fast = way.fast;
    return options;
}

gaussmap::SurfaceDistance distance(const Surface& s, const Decimation& d) {
    gaussmap::DistanceOptions options;
    options.samples = 30000;
    return gaussmap::surface_distance(s.vertices, s.faces, d.vertices, d.faces, options);
}

TEST(Decimate, ASphereStaysOneAndNoFaceTurnsOver) {
    const Surface s = gaussmap::sphere(4, 1, {0.25, 0, 1});
    for (const Way& way : ways) {
        SCOPED_TRACE(way.name);
        const Decimation d = decimate(s.vertices, s.faces, to(400, way));
        EXPECT_EQ(d.stop, DecimationStop::target);
        EXPECT_EQ(d.faces.size() / 3, 400u);
        EXPECT_EQ(d.face_source.size(), 400u);
        const validity::Counts c = counts_of(d.vertices, d.faces);
        EXPECT_EQ(c.euler, 2);
        EXPECT_EQ(c.border_sides + c.crowded_sides + c.degenerate + c.duplicates + c.unused + c.unoriented, 0u);
        for (std::size_t f = 0; f < d.faces.size(); f += 3) {
            double a[3], b[3], n = 0;
            const double* p = &d.vertices[3 * d.faces[f]];
            for (int j = 0; j < 3; ++j)
                a[j] = d.vertices[3 * d.faces[f + 1] + j] - p[j], b[j] = d.vertices[3 * d.faces[f + 2] + j] - p[j];
            for (int j = 0; j < 3; ++j) n += p[j] * (a[(j + 1) % 3] * b[(j + 2) % 3] - a[(j + 2) % 3] * b[(j + 1) % 3]);
            EXPECT_GT(n, 0) << "face " << f / 3 << " looks inward";
        }
        // Midpoints lie inside.
        EXPECT_NEAR(c.volume, 4.0 / 3 * std::numbers::pi, way.method == DecimationMethod::edge ? 0.3 : 0.12);
    }
}

TEST(Decimate, HandlesAndBordersAreKeptToTheLast) {
    const Surface torus = gaussmap::torus(1, 0.4, 40, 20), tube = gaussmap::cylinder(1, 2, 40, 20);
    for (const Way& way : ways) {
        SCOPED_TRACE(way.name);
        const Decimation a = decimate(torus.vertices, torus.faces, to(0, way));
        EXPECT_EQ(a.stop, DecimationStop::validity);
        EXPECT_GT(a.refused_topology + a.refused_folding, 0u);
        EXPECT_EQ(counts_of(a.vertices, a.faces).euler, 0);
        EXPECT_LT(a.faces.size() / 3, 120u);
        const Decimation b = decimate(tube.vertices, tube.faces, to(0, way));
        const validity::Counts c = counts_of(b.vertices, b.faces);
        EXPECT_EQ(c.euler, 0);
        EXPECT_GE(c.border_sides, 6u);
        EXPECT_EQ(c.crowded_sides, 0u);
    }
}

TEST(Decimate, ThePlaneStaysThePlane) {
    const Surface s = gaussmap::plane(3, 2, 40, 30);
    for (const Way& way : ways) {
        if (way.method == DecimationMethod::edge) continue;  // midpoints cut the corners of the border
        SCOPED_TRACE(way.name);
        const Decimation d = decimate(s.vertices, s.faces, to(40, way));
        // The last collapse may take two faces where one was too many.
        EXPECT_LE(d.faces.size() / 3, 40u);
        EXPECT_GE(d.faces.size() / 3, 39u);
        for (std::size_t i = 2; i < d.vertices.size(); i += 3) EXPECT_NEAR(d.vertices[i], 0, 1e-12);
        EXPECT_NEAR(counts_of(d.vertices, d.faces).area, 6, 0.06);
    }
}

TEST(Decimate, BestIsNearerThanQemAndQemThanEdge) {
    // The maximum is one point of one mesh: means of three.
    double rms[3] = {}, most[3] = {};
    const DecimationMethod methods[] = {DecimationMethod::best, DecimationMethod::qem, DecimationMethod::edge};
    for (const unsigned seed : {1u, 2u, 3u}) {
        const Surface s = gaussmap::bumpy_sphere(1, 0.15, 6, 5, {0.2, 0, seed});
        for (int i = 0; i < 3; ++i) {
            DecimateOptions options = to(1000);
            options.method = methods[i];
            const auto found = distance(s, decimate(s.vertices, s.faces, options));
            rms[i] += found.symmetric.rms, most[i] += found.symmetric.max;
        }
    }
    EXPECT_LT(rms[0], 0.8 * rms[1]);
    EXPECT_LT(rms[1], 0.6 * rms[2]);
    EXPECT_LT(most[0], 0.8 * most[1]);
}

TEST(DecimateThreads, SameBitsForAnyNumberOfThreads) {
    const Surface s = gaussmap::bumpy_sphere(1, 0.2, 5, 5, {0.2, 0, 3});
    for (const Way& way : ways) {
        if (support::sanitized && !way.weights) continue;
        DecimateOptions options = to(1500, way);
        options.measure = !support::sanitized || &way == ways;
        options.sources = true;
        options.run.threads = 1;
        const Decimation one = decimate(s.vertices, s.faces, options);
        options.run.threads = 3;
        const Decimation three = decimate(s.vertices, s.faces, options);
        EXPECT_EQ(one.faces, three.faces) << way.name;
        EXPECT_TRUE(support::same_bits(one.vertices, three.vertices)) << way.name;
        EXPECT_EQ(one.max_error, three.max_error) << way.name;
        EXPECT_EQ(one.rms_error, three.rms_error) << way.name;
        for (std::size_t v = 0; v < one.vertex_source.size(); ++v) {
            ASSERT_EQ(one.vertex_source[v].face, three.vertex_source[v].face) << way.name;
            ASSERT_EQ(one.vertex_source[v].weights, three.vertex_source[v].weights) << way.name;
        }
    }
}

TEST(Decimate, TheUnitOfLengthDoesNotMatter) {
    const Surface s = gaussmap::bumpy_sphere(1, 0.2, 5, 4, {0.2, 0, 3});
    const double rms = distance(s, decimate(s.vertices, s.faces, to(500))).symmetric.rms;
    for (const double unit : {1e-9, 25.4, 1e9}) {
        Surface scaled = s;
        for (double& x : scaled.vertices) x *= unit;
        const auto found = distance(scaled, decimate(scaled.vertices, scaled.faces, to(500)));
        EXPECT_NEAR(found.symmetric.rms / unit, rms, 0.02 * rms) << unit;
    }
}

TEST(Decimate, TheOrderOfFacesHardlyMatters) {
    const Surface s = gaussmap::bumpy_sphere(1, 0.2, 5, 4, {0.2, 0, 3});
    support::Random random(5);
    Surface shuffled = s;
    for (std::size_t f = s.faces.size() / 3; f-- > 1;) {
        const std::size_t g = random.below(f + 1);
        for (int k = 0; k < 3; ++k) std::swap(shuffled.faces[3 * f + k], shuffled.faces[3 * g + k]);
        std::rotate(&shuffled.faces[3 * f], &shuffled.faces[3 * f] + random.below(3), &shuffled.faces[3 * f] + 3);
    }
    for (const Way& way : ways) {
        const double rms = distance(s, decimate(s.vertices, s.faces, to(500, way))).symmetric.rms;
        const double of_shuffled = distance(s, decimate(shuffled.vertices, shuffled.faces, to(500, way))).symmetric.rms;
        EXPECT_NEAR(of_shuffled, rms, 0.02 * rms) << way.name;
    }
}

TEST(Decimate, FastIsAboutAsNearAsQem) {
    double fast = 0, qem = 0;
    for (const unsigned seed : {1u, 2u, 3u}) {
        const Surface s = gaussmap::bumpy_sphere(1, 0.15, 6, 5, {0.2, 0, seed});
        fast += distance(s, decimate(s.vertices, s.faces, to(1000, ways[2]))).symmetric.rms;
        qem += distance(s, decimate(s.vertices, s.faces, to(1000, ways[3]))).symmetric.rms;
    }
    EXPECT_LT(fast, 1.1 * qem);
}

TEST(Decimate, TheErrorPromisedIsProven) {
    const Surface s = gaussmap::bumpy_sphere(2, 0.2, 5, 4, {0.2, 0, 3});
    for (const double error : {0.02, 0.005}) {
        DecimateOptions options;
        options.error = error;
        const Decimation d = decimate(s.vertices, s.faces, options);
        const double diagonal = gaussmap::box_diagonal(s.vertices, s.faces);
        EXPECT_LE(d.error_bound, error);
        EXPECT_LT(d.faces.size(), s.faces.size() / 2);
        gaussmap::HausdorffOptions bound;
        bound.tolerance = 1e-3 * error * diagonal;
        const auto there =
            gaussmap::hausdorff_bound(s.vertices, s.faces, gaussmap::ClosestIndex(d.vertices, d.faces), bound);
        const auto back =
            gaussmap::hausdorff_bound(d.vertices, d.faces, gaussmap::ClosestIndex(s.vertices, s.faces), bound);
        EXPECT_LE(std::max(there.lower, back.lower), error * diagonal);
        EXPECT_GT(std::max(there.upper, back.upper), 0.5 * error * diagonal) << "it could have gone further";
    }
}

TEST(Decimate, LockedBordersStayWhereTheyAre) {
    const Surface s = gaussmap::waves(2, 2, 0.2, 1, 30, 30);
    DecimateOptions options = to(400);
    options.lock_border = true;
    const Decimation d = decimate(s.vertices, s.faces, options);
    const auto border = [](const std::vector<double>& xyz) {
        std::set<std::array<double, 3>> points;
        for (std::size_t i = 0; i < xyz.size(); i += 3)
            if (std::abs(std::abs(xyz[i]) - 1) < 1e-9 || std::abs(std::abs(xyz[i + 1]) - 1) < 1e-9)
                points.insert({std::round(1e9 * xyz[i]), std::round(1e9 * xyz[i + 1]), std::round(1e9 * xyz[i + 2])});
        return points;
    };
    EXPECT_EQ(border(d.vertices), border(s.vertices));
    EXPECT_EQ(counts_of(d.vertices, d.faces).border_sides, counts_of(s.vertices, s.faces).border_sides);
}

TEST(Decimate, FeaturesAreFollowed) {
    // A roof: two planes that meet at 0.1 rad, noisy. Its ridge stays a chain of sides.
    Surface s = gaussmap::plane(2, 2, 41, 41);
    support::Random random(1);
    for (std::size_t i = 0; i < s.vertices.size(); i += 3)
        s.vertices[i + 2] =
            -0.3 * std::abs(s.vertices[i]) + (std::abs(s.vertices[i]) < 1e-9 ? 0 : 1e-3 * random.normal());
    DecimateOptions options = to(100);
    options.feature_angle = 20;
    const Decimation d = decimate(s.vertices, s.faces, options);
    double ridge = 0;
    std::set<std::array<std::int32_t, 2>> met;
    for (std::size_t c = 0; c < d.faces.size(); ++c) {
        const std::int32_t a = d.faces[c], b = d.faces[c % 3 == 2 ? c - 2 : c + 1];
        if (std::abs(d.vertices[3 * a]) > 1e-2 || std::abs(d.vertices[3 * b]) > 1e-2) continue;
        if (met.insert({std::min(a, b), std::max(a, b)}).second)
            ridge += std::abs(d.vertices[3 * a + 1] - d.vertices[3 * b + 1]);
    }
    EXPECT_NEAR(ridge, 2, 0.01);
}

TEST(CornerSeams, AreSidesWhoseFacesDisagree) {
    // A fan of three faces about vertex 0, open between 4 and 1; the values of corners are u v.
    const std::vector<std::int32_t> faces = {0, 1, 2, 0, 2, 3, 3, 4, 0};
    std::vector<double> uv = {0, 0, 1, 0, 2, 1, /**/ 0, 0, 2, 1, 3, 1, /**/ 3, 1, 4, 0, 0, 0};
    EXPECT_TRUE(gaussmap::corner_seams(faces, uv, 2).empty());
    uv[15] = 0.5;  // v of vertex 4, on no common side
    EXPECT_TRUE(gaussmap::corner_seams(faces, uv, 2).empty());
    uv[13] = 0.5;  // v of vertex 3 in the last face
    EXPECT_EQ(gaussmap::corner_seams(faces, uv, 2), (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 1, 0}));
    uv[0] = 0.25;  // u of vertex 0 in the first face
    EXPECT_EQ(gaussmap::corner_seams(faces, uv, 2), (std::vector<std::uint8_t>{0, 1, 0, 0, 1, 1, 0, 1, 0}));
    EXPECT_TRUE(gaussmap::corner_seams({}, {}, 2).empty());
    try {
        gaussmap::corner_seams(faces, uv, 3);
        FAIL() << "18 numbers for 27 were taken";
    } catch (const std::invalid_argument& e) {
        EXPECT_STREQ(e.what(), "values has 18 entries, but there are 27 numbers of corners");
    }
}

TEST(Decimate, SeamsStayAndValuesComeFromTheirSide) {
    const Surface s = gaussmap::waves(2, 2, 0.1, 1.5, 41, 41);
    // The left and the right half are charts; the seam is the line x = 0.
    DecimateOptions options = to(200);
    options.sources = true;
    options.seams.assign(s.faces.size(), 0);
    const auto on_line = [&](std::int32_t v) { return std::abs(s.vertices[3 * v]) < 1e-9; };
    const auto left = [&](std::size_t f) {
        return s.vertices[3 * s.faces[3 * f]] + s.vertices[3 * s.faces[3 * f + 1]] +
                   s.vertices[3 * s.faces[3 * f + 2]] <
               0;
    };
    for (std::size_t c = 0; c < s.faces.size(); ++c)
        options.seams[c] = on_line(s.faces[c - c % 3 + (c + 1) % 3]) && on_line(s.faces[c - c % 3 + (c + 2) % 3]);
    const Decimation d = decimate(s.vertices, s.faces, options);
    ASSERT_EQ(d.corner_source.size(), d.faces.size());
    ASSERT_EQ(d.vertex_source.size(), d.vertices.size() / 3);
    std::size_t on_seam = 0;
    for (std::size_t c = 0; c < d.faces.size(); ++c) {
        const bool side = left(static_cast<std::size_t>(d.face_source[c / 3]));
        EXPECT_EQ(left(static_cast<std::size_t>(d.corner_source[c].face)), side);
        const double x = d.vertices[3 * d.faces[c]];
        EXPECT_TRUE(side ? x < 0.02 : x > -0.02) << x;
        on_seam += std::abs(x) < 0.02;
        // The source is where the vertex is.
        const gaussmap::SurfacePoint& p = d.corner_source[c];
        double at[3] = {0, 0, 0};
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j) at[j] += p.weights[k] * s.vertices[3 * s.faces[3 * p.face + k] + j];
        EXPECT_LT(std::hypot(at[0] - x, at[1] - d.vertices[3 * d.faces[c] + 1], at[2] - d.vertices[3 * d.faces[c] + 2]),
                  0.05);
    }
    EXPECT_GT(on_seam, 10u);
}

TEST(Decimate, SourcesAreNear) {
    const Surface s = gaussmap::bumpy_sphere(1, 0.15, 6, 5, {0.2, 0.02, 3});
    const gaussmap::ClosestIndex fine(s.vertices, s.faces);
    for (const Way& way : ways) {
        SCOPED_TRACE(way.name);
        DecimateOptions options = to(1000, way);
        options.sources = true;
        const Decimation d = decimate(s.vertices, s.faces, options);
        ASSERT_EQ(d.vertex_source.size(), d.vertices.size() / 3);
        const auto nearest = fine.closest(d.vertices).distance;
        double found = 0, least = 0;
        for (std::size_t v = 0; v < nearest.size(); ++v) {
            const gaussmap::SurfacePoint& p = d.vertex_source[v];
            EXPECT_NEAR(p.weights[0] + p.weights[1] + p.weights[2], 1, 1e-12);
            double at[3] = {0, 0, 0};
            for (int k = 0; k < 3; ++k)
                for (int j = 0; j < 3; ++j) at[j] += p.weights[k] * s.vertices[3 * s.faces[3 * p.face + k] + j];
            const double* q = &d.vertices[3 * v];
            const double apart = std::hypot(at[0] - q[0], at[1] - q[1], at[2] - q[2]);
            EXPECT_GE(apart, nearest[v] - 1e-12);
            found += apart, least += nearest[v];
        }
        EXPECT_LT(found, 1.1 * least + 1e-9) << found / static_cast<double>(nearest.size());
    }
}

TEST(Decimate, HolesCloseOnlyWhenAllowed) {
    Surface s = gaussmap::sphere(2);
    s.faces.resize(s.faces.size() - 3);  // a hole of one face
    const Decimation kept = decimate(s.vertices, s.faces, to(8, ways[3]));
    EXPECT_EQ(counts_of(kept.vertices, kept.faces).euler, 1);
    DecimateOptions options = to(8, ways[3]);
    options.allow_topology = true;
    const Decimation closed = decimate(s.vertices, s.faces, options);
    const validity::Counts c = counts_of(closed.vertices, closed.faces);
    EXPECT_EQ(c.euler, 2);
    EXPECT_EQ(c.border_sides + c.crowded_sides + c.degenerate, 0u);
}

TEST(Decimate, NothingAndLittleAreAnswered) {
    EXPECT_TRUE(decimate({}, {}, to(0)).faces.empty());
    const std::vector<double> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::vector<std::int32_t> one = {0, 1, 2};
    const Decimation d = decimate(corners, one, to(0));
    EXPECT_EQ(d.faces.size(), 3u);
    EXPECT_EQ(d.stop, DecimationStop::validity);
    EXPECT_EQ(decimate(corners, one, to(1)).stop, DecimationStop::target);
    EXPECT_EQ(decimate(corners, one, to(7)).vertices.size(), 9u);
}

TEST(Decimate, WhatCannotBeUsedIsLeftOutAndCounted) {
    Surface s = gaussmap::sphere(3);
    s.vertices.insert(s.vertices.end(), {NAN, 0, 0, std::numeric_limits<double>::infinity(), 0, 0});
    s.faces.insert(s.faces.end(), {0, 1, 642, 3, 3, 4, 643, 5, 6, 7, 8, 7});
    const Decimation d = decimate(s.vertices, s.faces, to(300));
    EXPECT_EQ(d.non_finite, 2u);
    EXPECT_EQ(d.degenerate, 2u);
    EXPECT_EQ(d.faces.size() / 3, 300u);
    EXPECT_EQ(counts_of(d.vertices, d.faces).euler, 2);
}

TEST(Decimate, DuplicatedAndNonManifoldFacesAreTakenAsTheyAre) {
    Surface s = gaussmap::sphere(3);
    // Ten faces twice, one of them turned round, and a fin on a side.
    for (std::int32_t i = 0; i < 30; ++i) s.faces.push_back(s.faces[300 + i]);
    std::swap(s.faces[s.faces.size() - 1], s.faces[s.faces.size() - 2]);
    s.vertices.insert(s.vertices.end(), {2, 2, 2});
    s.faces.insert(s.faces.end(), {s.faces[0], s.faces[1], static_cast<std::int32_t>(s.vertices.size() / 3 - 1)});
    const validity::Counts before = counts_of(s.vertices, s.faces);
    for (const Way& way : ways) {
        const Decimation d = decimate(s.vertices, s.faces, to(200, way));
        const validity::Counts after = counts_of(d.vertices, d.faces);
        EXPECT_LE(after.crowded_sides, before.crowded_sides) << way.name;
        EXPECT_LE(after.duplicates, before.duplicates) << way.name;
        EXPECT_EQ(after.degenerate, 0u) << way.name;
        EXPECT_EQ(after.parts, 1u) << way.name;
    }
}

TEST(Decimate, ProgressEndsItWhenItSaysSo) {
    const Surface s = gaussmap::sphere(4);
    DecimateOptions options = to(100);
    options.run.progress = [](double) { return false; };
    EXPECT_THROW(decimate(s.vertices, s.faces, options), gaussmap::Cancelled);
}

std::string message(const std::vector<std::int32_t>& faces, const DecimateOptions& options) {
    static const std::vector<double> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    try {
        decimate(corners, faces, options);
    } catch (const std::invalid_argument& error) { return error.what(); }
    return "nothing was thrown";
}

TEST(Decimate, SaysWhatIsWrongWithItsArguments) {
    EXPECT_EQ(message({0, 1, 3}, {}), "faces[0][2] = 3 is outside [0, 3)");
    EXPECT_EQ(message({0, -1, 2}, {}), "faces[0][1] = -1 is outside [0, 3)");
    DecimateOptions options;
    options.seams = {1, 0};
    EXPECT_EQ(message({0, 1, 2}, options), "seams has 2 entries, but there are 3 corners");
    options = {};
    options.feature_angle = -1;
    EXPECT_EQ(message({0, 1, 2}, options), "feature_angle = -1.000000 is outside [0, 180]");
    options = {};
    options.error = NAN;
    EXPECT_EQ(message({0, 1, 2}, options), "error = nan must be finite and not negative");
}

}  // namespace
