// The parts of the fit against slow references.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../../src/decimation_input.h"
#include "../../src/face_boxes.h"
#include "../../src/face_frame.h"
#include "../../src/surface_fit.h"
#include "../../src/surface_rounds.h"
#include "../../src/triangle_closest.h"
#include "gaussmap/decimate.h"
#include "gaussmap/distance.h"
#include "gaussmap/surfaces.h"
#include "support.h"

namespace {

using gaussmap::DecimationInput;
using gaussmap::FaceHit;
using gaussmap::RingMesh;
using gaussmap::Surface;
using gaussmap::Vec3;

Surface bumpy(int subdivisions) {
    return gaussmap::bumpy_sphere(1, 0.2, 5, subdivisions, {0.2, 0, 3});
}

std::vector<double> flat(const std::vector<Vec3>& points) {
    std::vector<double> out;
    for (const Vec3 p : points) out.insert(out.end(), {p.x, p.y, p.z});
    return out;
}

/// A result in the box of its input, and the vertex of it nearest to each of the input's, which it may have joined.
struct Pair {
    DecimationInput in;
    RingMesh coarse{{}, {}};
    std::vector<std::int32_t> joined;
};
Pair decimated(const Surface& s, std::size_t faces) {
    Pair pair;
    pair.in = gaussmap::decimation_input(s.vertices, s.faces, {});
    gaussmap::DecimateOptions options;
    options.faces = faces;
    options.fast = true;
    const gaussmap::Decimation made = gaussmap::decimate(s.vertices, s.faces, options);
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < made.vertices.size(); i += 3)
        positions.push_back(1 / pair.in.diagonal * (gaussmap::load(&made.vertices[i]) - pair.in.centre));
    const std::vector<double> vertices = flat(positions), places = flat(pair.in.positions);
    pair.joined = gaussmap::ClosestIndex(vertices).closest(places).element;
    pair.coarse = RingMesh(std::move(positions), made.faces);
    pair.coarse.tag_irregular_sides();
    pair.coarse.find_kinds();
    return pair;
}

TEST(FaceBoxes, FindWhatIsClosest) {
    const Surface s = bumpy(4);
    const DecimationInput in = gaussmap::decimation_input(s.vertices, s.faces, {});
    const gaussmap::FaceBoxes boxes = gaussmap::face_boxes(in.positions, in.corners, {});
    const auto faces = static_cast<std::int32_t>(in.faces.size());
    support::Random random(7);
    for (int trial = 0; trial < 2000; ++trial) {
        const double reach = trial % 2 ? 0.01 : 0.5;  // near the surface, and anywhere
        Vec3 q = in.positions[random.below(in.positions.size())];
        q = q + reach * Vec3{random.normal(), random.normal(), random.normal()};
        q = {std::clamp(q.x, -1.0, 1.0), std::clamp(q.y, -1.0, 1.0), std::clamp(q.z, -1.0, 1.0)};
        FaceHit least;
        for (std::int32_t f = 0; f < faces; ++f)
            if (const FaceHit hit = gaussmap::hit_of(boxes, f, q); hit.squared < least.squared) least = hit;
        const FaceHit start = gaussmap::hit_of(boxes, static_cast<std::int32_t>(random.below(in.faces.size())), q);
        EXPECT_EQ(gaussmap::closest_face(boxes, q).squared, least.squared);
        EXPECT_EQ(gaussmap::closest_face(boxes, q, start).squared, least.squared);
        // Near enough is enough, and where nothing is, the closest of all is found.
        const double enough = 2 * least.squared;
        EXPECT_LE(gaussmap::closest_face(boxes, q, start, enough).squared, enough);
        EXPECT_EQ(gaussmap::closest_face(boxes, q, start, 0.5 * least.squared).squared, least.squared);
    }
}

TEST(FaceBoxes, AreOfAsManyFacesAsThereAre) {
    // One face, a run and one, a node and one.
    for (const std::size_t count : {1, 5, 33, 257}) {
        std::vector<Vec3> positions;
        std::vector<std::int32_t> corners(3 * count);
        std::iota(corners.begin(), corners.end(), 0);
        for (std::size_t f = 0; f < count; ++f) {
            const double x = static_cast<double>(f) / 300;
            positions.insert(positions.end(), {{x, 0, 0}, {x, 1e-3, 0}, {x, 0, 1e-3}});
        }
        const gaussmap::FaceBoxes boxes = gaussmap::face_boxes(positions, corners, {});
        for (std::size_t f = 0; f < count; ++f) {
            const Vec3 q = {static_cast<double>(f) / 300 + 1e-4, 2e-4, 2e-4};
            const FaceHit found = gaussmap::closest_face(boxes, q);
            EXPECT_EQ(found.face, static_cast<std::int32_t>(f)) << "of " << count;
            EXPECT_NEAR(found.squared, 1e-8, 1e-15);
        }
    }
}

TEST(FaceFrame, AgreesWithTheClosestPoint) {
    support::Random random(3);
    const auto place = [&] { return Vec3{random.normal(), random.normal(), random.normal()}; };
    int inside = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const Vec3 a = place(), b = place(), c = place(), p = place();
        const gaussmap::TriangleHit hit = gaussmap::closest_on_triangle(p, a, b, c);
        const gaussmap::FaceFrame frame(a, b, c);
        const gaussmap::FaceFrame::Foot foot = frame.foot(p);
        const bool above = hit.u > 0 && hit.v > 0 && hit.w > 0;
        if (std::min({std::abs(foot.weights[0]), std::abs(foot.weights[1]), std::abs(foot.weights[2])}) > 1e-9) {
            EXPECT_EQ(foot.inside, above);
        }
        if (!foot.inside) continue;
        ++inside;
        EXPECT_NEAR(foot.height * foot.height, hit.squared, 1e-9 * (1 + hit.squared));
        EXPECT_NEAR(foot.weights[0], hit.u, 1e-6);
        EXPECT_NEAR(foot.weights[1], hit.v, 1e-6);
        EXPECT_NEAR(foot.weights[2], hit.w, 1e-6);
        // Settled: nearer to the foot than that is to any side.
        double aside = HUGE_VAL;
        const Vec3 at = hit.u * a + hit.v * b + hit.w * c;
        for (const auto& [s, t] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}})
            aside = std::min(aside, gaussmap::squared(gaussmap::cross(at - s, t - s)) / gaussmap::squared(t - s));
        if (std::abs(aside - hit.squared) > 1e-6 * aside) { EXPECT_EQ(frame.settled(foot), hit.squared < aside); }
    }
    EXPECT_GT(inside, 500);
    const gaussmap::FaceFrame line({0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    EXPECT_FALSE(line.settled(line.foot({0.5, 1, 0})));
}

TEST(SurfaceFit, SamplesStandForTheAreaAndKnowTheirFaces) {
    const Surface s = bumpy(5);
    Pair pair = decimated(s, 2000);
    gaussmap::AreaSamples samples = gaussmap::area_samples(pair.in, pair.joined, pair.coarse, {});
    double area = 0, truth = 0;
    for (const float a : samples.area) area += a;
    for (std::size_t c = 0; c < pair.in.corners.size(); c += 3) {
        const Vec3 p = pair.in.positions[pair.in.corners[c]];
        truth += 0.5 * gaussmap::length(gaussmap::cross(pair.in.positions[pair.in.corners[c + 1]] - p,
                                                        pair.in.positions[pair.in.corners[c + 2]] - p));
    }
    EXPECT_NEAR(area, truth, 1e-6 * truth);
    const auto exact_rms = [&] {
        const std::vector<double> vertices = flat(pair.coarse.position), places = flat(samples.point);
        const std::vector<double> d = gaussmap::ClosestIndex(vertices, pair.coarse.vertex).distances(places);
        double sum = 0;
        for (std::size_t i = 0; i < d.size(); ++i) sum += samples.area[i] * d[i] * d[i];
        return std::sqrt(sum / area);
    };
    const auto rows = [&] { return gaussmap::by_face(samples, pair.coarse.tags.size()); };
    const double before = samples.rms;
    EXPECT_NEAR(before, exact_rms(), 1e-3 * before);
    // One move and its flips bring them nearer, and the faces are still known.
    gaussmap::FitNorm norm;
    norm.scale = 1 / before;
    const gaussmap::FaceSamples had = rows();
    gaussmap::move_vertices(pair.coarse, samples, had, norm, {});
    gaussmap::assign(pair.coarse, samples, had, {});
    const double moved = samples.rms;
    EXPECT_LT(moved, 0.9 * before);
    EXPECT_NEAR(moved, exact_rms(), 1e-3 * moved);
    EXPECT_GT(gaussmap::flip_sides(pair.coarse, samples, norm, {}), 0u);
    gaussmap::assign(pair.coarse, samples, rows(), {});
    const double flipped = samples.rms;
    EXPECT_LT(flipped, moved);
    EXPECT_NEAR(flipped, exact_rms(), 1e-3 * flipped);
}

TEST(SurfaceFit, VerticesCountWhereTheSurfaceBends) {
    const Surface round = gaussmap::sphere(6);
    const Pair smooth = decimated(round, 2000);
    EXPECT_EQ(gaussmap::area_samples(smooth.in, smooth.joined, smooth.coarse, {}).point.size(), smooth.in.faces.size());
    Surface roof = gaussmap::plane(2, 2, 41, 41);
    for (std::size_t i = 0; i < roof.vertices.size(); i += 3) roof.vertices[i + 2] = -0.3 * std::abs(roof.vertices[i]);
    const Pair bent = decimated(roof, 200);
    const gaussmap::AreaSamples samples = gaussmap::area_samples(bent.in, bent.joined, bent.coarse, {});
    const std::size_t faces = bent.in.faces.size();
    ASSERT_GT(samples.point.size(), faces + 30);  // the ridge, and nothing else
    ASSERT_LT(samples.point.size(), faces + 50);
    for (std::size_t i = faces; i < samples.point.size(); ++i)
        EXPECT_NEAR(bent.in.centre.x + bent.in.diagonal * samples.point[i].x, 0, 1e-12);
}

TEST(SurfaceFit, PeaksFallAndLittleElseChanges) {
    const Surface s = bumpy(5);
    const Pair start = decimated(s, 1000);
    double rms[2], most[2];
    int i = 0;
    for (const auto objective : {gaussmap::DecimationObjective::rms, gaussmap::DecimationObjective::both}) {
        RingMesh coarse = start.coarse;
        const gaussmap::FaceBoxes fine = gaussmap::face_boxes(start.in.positions, start.in.corners, {});
        gaussmap::bring_nearer(coarse, start.in, fine, start.joined, objective, {});
        const std::vector<double> a = flat(start.in.positions), b = flat(coarse.position);
        const auto d = gaussmap::surface_distance(a, start.in.corners, b, coarse.vertex);
        rms[i] = d.symmetric.rms, most[i++] = d.symmetric.max;
    }
    EXPECT_LT(most[1], 0.95 * most[0]);
    EXPECT_LT(rms[1], 1.05 * rms[0]);
}

TEST(Decimate, TheDistanceMeasuredIsThatOfSurfaceDistance) {
    const Surface s = bumpy(5);
    for (const bool fast : {false, true}) {
        gaussmap::DecimateOptions options;
        options.faces = 1000;
        options.fast = fast;
        options.measure = true;
        const gaussmap::Decimation d = gaussmap::decimate(s.vertices, s.faces, options);
        const auto truth = gaussmap::surface_distance(s.vertices, s.faces, d.vertices, d.faces);
        EXPECT_NEAR(d.rms_error, truth.symmetric.rms / truth.diagonal, 0.01 * d.rms_error);
        EXPECT_NEAR(d.max_error, truth.symmetric.max / truth.diagonal, 0.05 * d.max_error);
        options.measure = false;
        EXPECT_EQ(gaussmap::decimate(s.vertices, s.faces, options).max_error, 0);
    }
}

}  // namespace
