// Closed-form values, layouts that others rely on, and the errors.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "gaussmap/inspect.h"
#include "gaussmap/io.h"
#include "gaussmap/surfaces.h"
#include "support.h"

namespace {

using gaussmap::Surface;
using gaussmap::SurfaceOptions;

TEST(Sphere, HasTwentyTimesFourToTheSFaces) {
    for (int s = 0; s <= 5; ++s) {
        const Surface sphere = gaussmap::sphere(s);
        EXPECT_EQ(sphere.faces.size() / 3, 20u << (2 * s));
        EXPECT_EQ(sphere.vertices.size() / 3, (10u << (2 * s)) + 2);
    }
}

TEST(Sphere, CurvesOneOverRadiusEverywhere) {
    const Surface sphere = gaussmap::sphere(3, 0.5);
    for (std::size_t v = 0; v < sphere.k1.size(); ++v) {
        EXPECT_EQ(sphere.k1[v], 2);
        EXPECT_EQ(sphere.k2[v], 2);
        EXPECT_EQ(sphere.density[v], 8);
        for (std::size_t i = 3 * v; i < 3 * v + 3; ++i) EXPECT_EQ(sphere.vertices[i], 0.5 * sphere.normals[i]);
    }
}

TEST(Sphere, VerticesOfALevelStayInTheNext) {
    // Pushed to the sphere at every level, so the points of a coarse sphere are among those of a finer one.
    const auto points = [](int s) {
        const Surface sphere = gaussmap::sphere(s);
        std::vector<std::array<double, 3>> p;
        for (std::size_t i = 0; i < sphere.vertices.size(); i += 3)
            p.push_back({sphere.vertices[i], sphere.vertices[i + 1], sphere.vertices[i + 2]});
        std::sort(p.begin(), p.end());
        return p;
    };
    const auto coarse = points(2), fine = points(4);
    EXPECT_TRUE(std::includes(fine.begin(), fine.end(), coarse.begin(), coarse.end()));
}

TEST(Sphere, NeighboursInIndexAreNearInSpace) {
    const Surface sphere = gaussmap::sphere(6);
    std::size_t near = 0;
    for (std::size_t f = 0; f < sphere.faces.size(); f += 3) {
        const auto [low, high] = std::minmax({sphere.faces[f], sphere.faces[f + 1], sphere.faces[f + 2]});
        near += high - low <= 65 ? 1 : 0;  // within a row of 2⁶ or the next
    }
    EXPECT_GT(static_cast<double>(near), 0.9 * static_cast<double>(sphere.faces.size() / 3));
}

TEST(Sphere, HasThePointsOfThePapersIcosphere) {
    NEED_DATA();
    const auto file = gaussmap::read(support::data_folder() / "meshes/seed/icosahedron_subdivide_4.ply");
    const Surface sphere = gaussmap::sphere(4);
    ASSERT_EQ(sphere.vertices.size(), file.vertices.size());
    ASSERT_EQ(sphere.faces.size(), file.faces.size());
    // Six digits a coordinate in the file; a sort by rounded coordinates would split ties, so nearest points are
    // sought.
    for (std::size_t i = 0; i < file.vertices.size(); i += 3) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < sphere.vertices.size(); j += 3)
            nearest = std::min(nearest, std::max({std::abs(sphere.vertices[j] - file.vertices[i]),
                                                  std::abs(sphere.vertices[j + 1] - file.vertices[i + 1]),
                                                  std::abs(sphere.vertices[j + 2] - file.vertices[i + 2])}));
        ASSERT_LT(nearest, 2e-6) << "vertex " << i / 3;
    }
}

TEST(Torus, HasTheLayoutOfOpen3D) {
    NEED_DATA();
    for (const int n : {9, 18, 36}) {
        const auto file =
            gaussmap::read(support::data_folder() / ("meshes/seed/torus_res" + std::to_string(n) + ".ply"));
        const Surface torus = gaussmap::torus(1, 0.5, n, n);
        EXPECT_EQ(torus.faces, file.faces);
        ASSERT_EQ(torus.vertices.size(), file.vertices.size());
        for (std::size_t i = 0; i < file.vertices.size(); ++i) EXPECT_NEAR(torus.vertices[i], file.vertices[i], 4e-15);
    }
}

TEST(Torus, CurvesAsTheFormulaSays) {
    const Surface torus = gaussmap::torus(3, 1, 12, 8);
    for (std::size_t v = 0; v < torus.k1.size(); ++v) {
        const double theta = 2 * std::numbers::pi * static_cast<double>(v % 8) / 8;
        EXPECT_EQ(torus.k1[v], 1);
        EXPECT_NEAR(torus.k2[v], std::cos(theta) / (3 + std::cos(theta)), 1e-15);
    }
}

TEST(Tube, OfAThinTorusKnotWindsAsToldAndHasTheTubesArea) {
    // p = 3 turns about the axis, q = 2 about the tube: the signed angle of the rows' centres tells.
    const int rows = 400, columns = 16;
    const Surface knot = gaussmap::torus_knot(3, 2, 2, 0.5, 0.1, rows, columns);
    std::vector<std::array<double, 3>> centre(rows);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j)
            for (int c = 0; c < 3; ++c) centre[i][c] += knot.vertices[3 * (i * columns + j) + c] / columns;
    double about_axis = 0, about_tube = 0;
    const auto tube_angle = [&](int i) { return std::atan2(centre[i][2], std::hypot(centre[i][0], centre[i][1]) - 2); };
    for (int i = 0; i < rows; ++i) {
        const int next = (i + 1) % rows;
        about_axis +=
            std::remainder(std::atan2(centre[next][1], centre[next][0]) - std::atan2(centre[i][1], centre[i][0]),
                           2 * std::numbers::pi);
        about_tube += std::remainder(tube_angle(next) - tube_angle(i), 2 * std::numbers::pi);
    }
    EXPECT_NEAR(about_axis, 3 * 2 * std::numbers::pi, 1e-9);
    EXPECT_NEAR(about_tube, 2 * 2 * std::numbers::pi, 1e-9);
}

TEST(Tube, ClosesWithoutATwistThatShearsTheGrid) {
    // The frame turns as little as it can: rows differ by about a step along the curve, the last and first one too.
    const int rows = 400, columns = 16;
    const Surface knot = gaussmap::torus_knot(2, 3, 1, 0.4, 0.12, rows, columns);
    double worst = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const int a = 3 * (i * columns + j), b = 3 * ((i + 1) % rows * columns + j);
            worst = std::max(
                worst, std::hypot(knot.vertices[b] - knot.vertices[a], knot.vertices[b + 1] - knot.vertices[a + 1],
                                  knot.vertices[b + 2] - knot.vertices[a + 2]));
        }
    const double fastest = std::hypot(2 * 1.4, 3 * 0.4) * 2 * std::numbers::pi / rows;  // |γ′| Δt
    EXPECT_LT(worst, 1.5 * fastest);
}

TEST(Tube, OfACoarseGridIsStillExact) {
    const Surface knot = gaussmap::figure_eight_knot(1, 0.1, 4, 3);
    for (std::size_t v = 0; v < knot.k1.size(); ++v) {
        EXPECT_DOUBLE_EQ(knot.k1[v], 10);
        EXPECT_NEAR(std::hypot(knot.normals[3 * v], knot.normals[3 * v + 1], knot.normals[3 * v + 2]), 1, 1e-15);
    }
}

TEST(Catenoid, IsMinimal) {
    const Surface catenoid = gaussmap::catenoid(2, 3, 20, 11);
    for (std::size_t v = 0; v < catenoid.k1.size(); ++v) EXPECT_EQ(catenoid.k1[v], -catenoid.k2[v]);
    EXPECT_EQ(catenoid.k1[5], 0.5);  // at the neck
    EXPECT_EQ(catenoid.vertices[3 * 5], 2);
}

TEST(Plane, IsExactlyFlatAndCentred) {
    const Surface plane = gaussmap::plane(4, 2, 5, 3, {0.25, 0, 3});
    EXPECT_TRUE(std::all_of(plane.density.begin(), plane.density.end(), [](double d) { return d == 0; }));
    const auto found = gaussmap::inspect(plane.vertices, plane.faces);
    EXPECT_EQ(found.minimum[0], -2);
    EXPECT_EQ(found.maximum[1], 1);
    EXPECT_DOUBLE_EQ(found.area, 8);
}

TEST(Options, JitterHasTheSameBitsOnEveryMachine) {
    // A plane needs nothing of libm, so these are the generator's own bits, worked out with Python's integers.
    const Surface plane = gaussmap::plane(2, 2, 3, 3, {0.25, 0, 42});
    EXPECT_EQ(plane.vertices[12], 0x1.cbdd96918e2e0p-3);
    EXPECT_EQ(plane.vertices[13], -0x1.2f45ab8b0fd40p-3);
}

TEST(Options, NoiseDoesNotDisturbTheJitter) {
    const Surface quiet = gaussmap::plane(2, 2, 9, 9, {0.25, 0, 42}),
                  noisy = gaussmap::plane(2, 2, 9, 9, {0.25, 1e-9, 42});
    for (std::size_t i = 0; i < quiet.vertices.size(); ++i) EXPECT_NEAR(quiet.vertices[i], noisy.vertices[i], 1e-8);
}

template <class Call>
std::string error_of(Call&& call) {
    try {
        call();
    } catch (const std::invalid_argument& error) { return error.what(); }
    return "no error";
}

TEST(Errors, NameTheParameterAndItsValue) {
    using namespace gaussmap;
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(error_of([] { sphere(13); }), "sphere: subdivisions = 13 must be in [0, 12]");
    EXPECT_EQ(error_of([] { sphere(-1); }), "sphere: subdivisions = -1 must be in [0, 12]");
    EXPECT_EQ(error_of([] { sphere(2, 0); }), "sphere: radius = 0 must be positive and finite");
    EXPECT_EQ(error_of([&] { sphere(2, nan); }), "sphere: radius = nan must be positive and finite");
    EXPECT_EQ(error_of([] { sphere(2, 1, {-0.5, 0, 0}); }), "sphere: jitter = -0.5 must be finite and at least 0");
    EXPECT_EQ(error_of([&] { sphere(2, 1, {0, infinity, 0}); }), "sphere: noise = inf must be finite and at least 0");
    EXPECT_EQ(error_of([] { torus(1, 2, 9, 9); }), "torus: minor = 2 must be less than major = 1");
    EXPECT_EQ(error_of([] { torus(1, 1, 9, 9); }), "torus: minor = 1 must be less than major = 1");
    EXPECT_EQ(error_of([] { torus(1, 0, 9, 9); }), "torus: minor = 0 must be positive and finite");
    EXPECT_EQ(error_of([] { torus(-1, 0.5, 9, 9); }), "torus: major = -1 must be positive and finite");
    EXPECT_EQ(error_of([] { torus(1, 0.5, 2, 9); }), "torus: around = 2 must be at least 3");
    EXPECT_EQ(error_of([] { torus(1, 0.5, 9, 0); }), "torus: across = 0 must be at least 3");
    EXPECT_EQ(error_of([] { plane(1, 1, 65536, 32768); }),
              "plane: around × across = 65536 × 32768 vertices must be at most 2147483647");
    EXPECT_EQ(error_of([&] { torus(1, 0.5, 9, 9, {nan, 0, 0}); }), "torus: jitter = nan must be finite and at least 0");
}

TEST(Errors, OfTubes) {
    using namespace gaussmap;
    EXPECT_EQ(error_of([] { torus_knot(0, 3, 1, 0.4, 0.1, 9, 9); }), "torus_knot: p = 0 must be at least 1");
    EXPECT_EQ(error_of([] { torus_knot(2, -3, 1, 0.4, 0.1, 9, 9); }), "torus_knot: q = -3 must be at least 1");
    EXPECT_EQ(error_of([] { torus_knot(4, 6, 1, 0.4, 0.1, 9, 9); }),
              "torus_knot: q = 6 must have no common divisor with p = 4");
    EXPECT_EQ(error_of([] { torus_knot(2, 3, 1, 1.5, 0.1, 9, 9); }),
              "torus_knot: minor = 1.5 must be less than major = 1");
    EXPECT_EQ(error_of([] { torus_knot(2, 3, 1, 0.4, 0, 9, 9); }), "torus_knot: tube = 0 must be positive and finite");
    EXPECT_EQ(error_of([] { torus_knot(2, 3, 1, 0.4, 0.1, 9, 1); }), "torus_knot: across = 1 must be at least 3");
    const std::string fat = error_of([] { torus_knot(2, 3, 1, 0.4, 2, 9, 9); });
    const std::string text = "torus_knot: tube = 2 must be less than the curve's smallest radius of curvature, ";
    ASSERT_EQ(fat.substr(0, text.size()), text);
    EXPECT_NEAR(std::stod(fat.substr(text.size())), 0.76551490, 1e-6);  // by finite differences of the curve
    EXPECT_EQ(error_of([] { figure_eight_knot(-1, 0.1, 9, 9); }),
              "figure_eight_knot: scale = -1 must be positive and finite");
    EXPECT_NE(error_of([] { figure_eight_knot(1, 5, 9, 9); }).find("figure_eight_knot: tube = 5 must be less"),
              std::string::npos);
}

TEST(Errors, OfTheOthers) {
    using namespace gaussmap;
    EXPECT_EQ(error_of([] { ellipsoid(1, 0, 1, 2); }), "ellipsoid: b = 0 must be positive and finite");
    EXPECT_EQ(error_of([] { ellipsoid(1, 1, 1, 20); }), "ellipsoid: subdivisions = 20 must be in [0, 12]");
    EXPECT_EQ(error_of([] { bumpy_sphere(1, 1, 3, 2); }), "bumpy_sphere: amplitude = 1 must be in (-1, 1)");
    EXPECT_EQ(error_of([] { bumpy_sphere(0, 0.1, 3, 2); }), "bumpy_sphere: radius = 0 must be positive and finite");
    EXPECT_EQ(error_of([] { bumpy_sphere(1, 0.1, INFINITY, 2); }), "bumpy_sphere: frequency = inf must be finite");
    EXPECT_EQ(error_of([] { catenoid(0, 1, 9, 9); }), "catenoid: neck = 0 must be positive and finite");
    EXPECT_EQ(error_of([] { catenoid(1, 9000, 9, 9); }),
              "catenoid: height = 9000 must be less for a rim that is a number, neck being 1");
    EXPECT_EQ(error_of([] { cylinder(1, -2, 9, 9); }), "cylinder: height = -2 must be positive and finite");
    EXPECT_EQ(error_of([] { plane(1, 0, 9, 9); }), "plane: depth = 0 must be positive and finite");
    EXPECT_EQ(error_of([] { waves(1, 1, NAN, 1, 9, 9); }), "waves: amplitude = nan must be finite");
    EXPECT_EQ(error_of([] { waves(1, 1, 1, 0, 9, 9); }), "waves: wavelength = 0 must be positive and finite");
    EXPECT_EQ(error_of([] { waves(1, 1, 1, 1, 9, 2); }), "waves: across = 2 must be at least 3");
}

}  // namespace
