// Total curvature of clouds by fans: against exact values, and what must not change it.
#include <algorithm>
#include <limits>
#include <numeric>

#include "clouds.h"
#include "gaussmap/curvature.h"

using namespace gaussmap;
using support::Cloud;
using support::Random;
using support::refusal;
using support::relative_rmse;

namespace {

const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

CloudCurvature fan_curvature(Points points, Points normals = {}, CloudCurvatureOptions options = {}) {
    options.estimator = Estimator::dirichlet;
    return cloud_curvature(points, normals, options);
}

CloudCurvatureOptions fitted(CloudNormals method, int degree, int k = 20) {
    CloudCurvatureOptions options;
    options.method = method;
    options.degree = degree;
    options.k = k;
    return options;
}

void expect_relative(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(std::isnan(a[i]), std::isnan(b[i])) << i;
        if (std::isnan(a[i])) continue;
        ASSERT_NEAR(a[i], b[i], tolerance * std::abs(b[i])) << i;
    }
}

/// Coordinates rounded so that a shift by a large power of two is exact.
std::vector<double> coarse(std::vector<double> values) {
    for (double& v : values) v = std::ldexp(std::round(std::ldexp(v, 24)), -24);
    return values;
}

std::vector<double> plus(std::vector<double> values, double shift) {
    for (double& v : values) v += shift;
    return values;
}

std::vector<double> scaled(std::vector<double> values, double by) {
    for (double& v : values) v *= by;
    return values;
}

}  // namespace

TEST(CloudCurvature, SphereWithExactNormalsIsExact) {
    for (const double radius : {1.0, 0.03, 500.0}) {
        const Cloud sphere = support::sphere_cloud(radius, 3000, 1);
        const CloudCurvature result = fan_curvature(sphere.points, sphere.normals);
        EXPECT_EQ(result.undefined, 0u);
        expect_relative(result.density, sphere.density, 1e-9);
        EXPECT_LT(relative_rmse(result.density, sphere.density), 1e-11);
    }
}

TEST(CloudCurvature, PlaneIsExactlyZero) {
    const Cloud plane = support::lattice_cloud(10, 7);
    for (const CloudNormals method : {CloudNormals::pca, CloudNormals::jet}) {
        const CloudCurvature result = fan_curvature(plane.points, {}, fitted(method, 4));
        EXPECT_EQ(result.density, plane.density);
        EXPECT_EQ(result.kappa, plane.density);
    }
    const CloudCurvature given = fan_curvature(plane.points, plane.normals);
    EXPECT_EQ(given.density, plane.density);
    EXPECT_EQ(given.undefined, 0u);
    EXPECT_EQ(given.boundary, 36u) << "the points on the border of a 10 by 10 lattice";
    EXPECT_EQ(given.normals, plane.normals);
}

TEST(CloudCurvature, ConvergesOnATorus) {
    double before[3] = {infinity, infinity, infinity};
    for (const double step : {0.12, 0.06, 0.03}) {
        const Cloud torus = support::torus_cloud(1, 0.5, step, 2);
        const double errors[3] = {
            relative_rmse(fan_curvature(torus.points, torus.normals).density, torus.density),
            relative_rmse(fan_curvature(torus.points, {}, fitted(CloudNormals::jet, 4)).density, torus.density),
            relative_rmse(fan_curvature(torus.points, {}, fitted(CloudNormals::jet, 2, 10)).density, torus.density)};
        for (int e = 0; e < 3; ++e) {
            EXPECT_LT(errors[e], before[e] / 1.8) << "of first order on irregular points, estimator " << e;
            before[e] = errors[e];
        }
    }
    EXPECT_LT(before[0], 0.005);
    EXPECT_LT(before[1], 1.05 * before[0]) << "quartic jets are as good as exact normals here";
    EXPECT_LT(before[2], 2 * before[0]);
    const Cloud torus = support::torus_cloud(1, 0.5, 0.03, 2);
    const double pca =
        relative_rmse(fan_curvature(torus.points, {}, fitted(CloudNormals::pca, 1)).density, torus.density);
    EXPECT_GT(pca, 0.1) << "principal directions do not converge: the paper's weak point";
    EXPECT_LT(pca, 0.5);
}

TEST(CloudCurvature, EllipsoidAndCylinder) {
    const Cloud ellipsoid = support::ellipsoid_cloud(1, 0.8, 0.6, 20000, 3);
    EXPECT_LT(relative_rmse(fan_curvature(ellipsoid.points, ellipsoid.normals).density, ellipsoid.density), 0.015);
    EXPECT_LT(relative_rmse(fan_curvature(ellipsoid.points).density, ellipsoid.density), 0.02);

    const Cloud cylinder = support::cylinder_cloud(0.5, 2, 0.04, 4);
    const CloudCurvature open = fan_curvature(cylinder.points, cylinder.normals);
    for (std::size_t i = 0; i < cylinder.count(); ++i)
        if (std::abs(cylinder.points[3 * i + 2] - 1) < 0.8) {
            ASSERT_NEAR(open.density[i], 4, 0.05) << "away from the ends";
        }
    EXPECT_GT(open.boundary, 20u);
    EXPECT_LT(open.boundary, cylinder.count() / 5);
    EXPECT_EQ(open.undefined, 0u);
}

TEST(CloudCurvature, ScaleLaw) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.06, 5);
    const CloudCurvature unit = fan_curvature(torus.points);
    const std::vector<double> large_points = scaled(torus.points, 1024), odd_points = scaled(torus.points, 3.7);
    const CloudCurvature large = fan_curvature(large_points);
    EXPECT_TRUE(support::same_bits(large.density, scaled(unit.density, 0x1p-20))) << "powers of two are exact";
    EXPECT_TRUE(support::same_bits(large.kappa, unit.kappa));
    const CloudCurvature other = fan_curvature(odd_points, torus.normals);
    const CloudCurvature given = fan_curvature(torus.points, torus.normals);
    expect_relative(other.density, scaled(given.density, 1 / (3.7 * 3.7)), 1e-9);
    expect_relative(other.kappa, given.kappa, 1e-9);
    // Where squares of the coordinates underflow all distances tie, but a shape of a few points is still measured.
    const Cloud few = support::sphere_cloud(1, 15, 6);
    const std::vector<double> tiny_points = scaled(few.points, 0x1p-600);
    const CloudCurvature tiny = fan_curvature(tiny_points, few.normals);
    EXPECT_TRUE(support::same_bits(tiny.kappa, fan_curvature(few.points, few.normals).kappa));
}

TEST(CloudCurvature, RigidMotions) {
    Random random(7);
    const Cloud torus = support::torus_cloud(1, 0.5, 0.06, 8);
    const std::vector<double> rotation = support::random_rotation(random);
    const std::vector<double> points = support::times(rotation, torus.points);
    const std::vector<double> normals = support::times(rotation, torus.normals);
    expect_relative(fan_curvature(points, normals).density, fan_curvature(torus.points, torus.normals).density, 1e-8);
    expect_relative(fan_curvature(points).density, fan_curvature(torus.points).density, 1e-6);

    const std::vector<double> near = coarse(torus.points), far = plus(near, 0x1p22);  // over 10⁶ diagonals away
    EXPECT_TRUE(support::same_bits(fan_curvature(near).density, fan_curvature(far).density));
    EXPECT_TRUE(
        support::same_bits(fan_curvature(near, torus.normals).density, fan_curvature(far, torus.normals).density));
}

TEST(CloudCurvature, NumberingOfThePointsDoesNotMatter) {
    Random random(9);
    const Cloud torus = support::torus_cloud(1, 0.5, 0.06, 10);
    std::vector<std::size_t> order(torus.count());
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    Cloud shuffled;
    for (const std::size_t i : order)
        shuffled.add({torus.points[3 * i], torus.points[3 * i + 1], torus.points[3 * i + 2]},
                     {torus.normals[3 * i], torus.normals[3 * i + 1], torus.normals[3 * i + 2]}, torus.density[i]);
    const CloudCurvature here = fan_curvature(torus.points), there = fan_curvature(shuffled.points);
    const CloudCurvature given = fan_curvature(torus.points, torus.normals);
    const CloudCurvature given_there = fan_curvature(shuffled.points, shuffled.normals);
    for (std::size_t i = 0; i < order.size(); ++i) {
        ASSERT_EQ(there.density[i], here.density[order[i]]);
        ASSERT_EQ(given_there.density[i], given.density[order[i]]);
    }
}

TEST(CloudCurvature, GlobalFlipChangesNoBit) {
    for (const Cloud& cloud : {support::torus_cloud(1, 0.5, 0.06, 11), support::cylinder_cloud(1, 1, 0.08, 12)}) {
        const CloudCurvature result = fan_curvature(cloud.points, cloud.normals);
        const std::vector<double> turned = scaled(cloud.normals, -1);
        const CloudCurvature flipped = fan_curvature(cloud.points, turned);
        EXPECT_TRUE(support::same_bits(result.density, flipped.density));
        EXPECT_TRUE(support::same_bits(result.kappa, flipped.kappa));
        EXPECT_EQ(result.boundary, flipped.boundary);
    }
}

TEST(CloudCurvature, OnlyEstimatedNormalsAreTurned) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.06, 13);
    CloudCurvatureOptions options;
    const CloudCurvature local = fan_curvature(torus.points, {}, options);
    options.orientation = Orientation::mst;
    const CloudCurvature tree = fan_curvature(torus.points, {}, options);
    EXPECT_TRUE(support::same_bits(local.density, tree.density));
    for (std::size_t i = 0; i < torus.count(); ++i)
        ASSERT_GT(support::dot3(&tree.normals[3 * i], &torus.normals[3 * i]), 0) << "outward everywhere";
    options.orientation = Orientation::none;
    const CloudCurvature left = fan_curvature(torus.points, {}, options);
    EXPECT_GT(relative_rmse(left.density, torus.density), 1) << "signs that disagree count as bending";

    Random random(14);
    std::vector<double> mixed = torus.normals;
    for (std::size_t i = 0; i < mixed.size(); i += 3)
        if (random.below(2) == 0)
            for (int c = 0; c < 3; ++c) mixed[i + c] = -mixed[i + c];
    options.orientation = Orientation::local;
    EXPECT_GT(relative_rmse(fan_curvature(torus.points, mixed, options).density, torus.density), 1);
}

TEST(CloudCurvature, GivenNormalsOfAnyLength) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.1, 15);
    const CloudCurvature result = fan_curvature(torus.points, torus.normals);
    for (const double by : {1e-300, 5.0, 1e300}) {
        const std::vector<double> normals = scaled(torus.normals, by);
        expect_relative(fan_curvature(torus.points, normals).density, result.density, 1e-12);
    }
    for (std::size_t i = 0; i < torus.normals.size(); ++i) ASSERT_NEAR(result.normals[i], torus.normals[i], 1e-15);
}

TEST(CloudCurvature, CopiesAndNonFinitePointsLeaveTheRestAlone) {
    Random random(16);
    const Cloud torus = support::torus_cloud(1, 0.5, 0.08, 17);
    for (const bool given : {true, false}) {
        const CloudCurvature clean = fan_curvature(torus.points, given ? Points(torus.normals) : Points());
        std::vector<double> points, normals;
        std::vector<std::size_t> drawn;  // which point an input is; count() where it is none
        const auto put = [&](std::size_t i) {
            drawn.push_back(i);
            points.insert(points.end(), &torus.points[3 * i], &torus.points[3 * i] + 3);
            normals.insert(normals.end(), &torus.normals[3 * i], &torus.normals[3 * i] + 3);
        };
        std::size_t copies = 0, broken = 0;
        for (std::size_t i = 0; i < torus.count(); ++i) {
            put(i);
            for (std::size_t c = random.below(40) == 0 ? 30 : 0; c > 0; --c, ++copies) put(random.below(i + 1));
            if (random.below(9) != 0) continue;
            drawn.push_back(torus.count());
            points.insert(points.end(), {1, random.below(2) == 0 ? not_a_number : infinity, 0});
            normals.insert(normals.end(), {0, 0, 1});
            ++broken;
        }
        const CloudCurvature result = fan_curvature(points, given ? Points(normals) : Points());
        EXPECT_EQ(result.duplicates, copies);
        EXPECT_EQ(result.non_finite, broken);
        EXPECT_EQ(result.undefined, broken);
        EXPECT_GT(copies, 300u);
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            if (drawn[i] == torus.count()) {
                ASSERT_TRUE(std::isnan(result.density[i]) && std::isnan(result.kappa[i]) &&
                            std::isnan(result.normals[3 * i]));
                continue;
            }
            ASSERT_EQ(result.density[i], clean.density[drawn[i]]);
            ASSERT_EQ(result.kappa[i], clean.kappa[drawn[i]]);
            for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(result.normals[3 * i + c], clean.normals[3 * drawn[i] + c]);
        }
    }
}

TEST(CloudCurvature, UndefinedNormalsMakeTheirOwnPointsUndefined) {
    const Cloud sphere = support::sphere_cloud(2, 1000, 18);
    std::vector<double> normals = sphere.normals;
    normals[3 * 10] = not_a_number;
    normals[3 * 11 + 1] = infinity;
    for (int c = 0; c < 3; ++c) normals[3 * 12 + c] = 0;
    const CloudCurvature result = fan_curvature(sphere.points, normals);
    EXPECT_EQ(result.undefined, 3u);
    for (std::size_t i = 0; i < sphere.count(); ++i) {
        if (i >= 10 && i <= 12) {
            ASSERT_TRUE(std::isnan(result.density[i]) && std::isnan(result.kappa[i]));
        } else {
            ASSERT_NEAR(result.density[i], 0.5, 1e-9) << "the triangles left are those of a sphere still";
        }
    }
    // A centre whose neighbours all have no normal has no triangle left.
    std::vector<double> nobody(normals.size(), not_a_number);
    for (int c = 0; c < 3; ++c) nobody[c] = sphere.normals[c];
    EXPECT_EQ(fan_curvature(sphere.points, nobody).undefined, sphere.count());
}

TEST(CloudCurvature, FewPoints) {
    EXPECT_TRUE(fan_curvature(Points()).density.empty());
    const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5};
    for (const std::size_t n : {1u, 2u}) {
        const CloudCurvature result = fan_curvature(Points(points.data(), n));
        EXPECT_EQ(result.undefined, n);
        EXPECT_EQ(result.density.size(), n);
    }
    const CloudCurvature three = fan_curvature(Points(points.data(), 3));
    EXPECT_EQ(three.density, (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(three.boundary, 3u);
    EXPECT_EQ(three.lowered, 3u);
    const CloudCurvature four = fan_curvature(points, {}, fitted(CloudNormals::pca, 4, 2000000000));
    EXPECT_EQ(four.undefined, 0u);
    EXPECT_EQ(four.lowered, 0u);
}

TEST(CloudCurvature, LinesAndPilesAreUndefined) {
    std::vector<double> line, pile(3 * 50, 1.25);
    for (int i = 0; i < 50; ++i) line.insert(line.end(), {0.1 * i, 0.2 * i, -0.3 * i});
    EXPECT_EQ(fan_curvature(line).undefined, 50u);
    EXPECT_EQ(fan_curvature(line, line).undefined, 50u) << "all in the direction of the normal";
    const CloudCurvature result = fan_curvature(pile);
    EXPECT_EQ(result.undefined, 50u);
    EXPECT_EQ(result.duplicates, 49u);
}

TEST(CloudCurvature, SameForAnyNumberOfThreads) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.035, 19);
    for (const Orientation orientation : {Orientation::local, Orientation::mst}) {
        CloudCurvatureOptions options;
        options.orientation = orientation;
        options.run.threads = 1;
        const CloudCurvature one = fan_curvature(torus.points, {}, options);
        for (const int threads : {2, 7}) {
            options.run.threads = threads;
            const CloudCurvature more = fan_curvature(torus.points, {}, options);
            EXPECT_TRUE(support::same_bits(one.density, more.density));
            EXPECT_TRUE(support::same_bits(one.kappa, more.kappa));
            EXPECT_TRUE(support::same_bits(one.normals, more.normals));
        }
    }
}

TEST(CloudCurvature, ReportsProgressAndCanBeCancelled) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.06, 20);
    CloudCurvatureOptions options;
    options.run.threads = 1;
    double last = 0;
    options.run.progress = [&](double done) {
        EXPECT_GE(done, last);
        last = done;
        return true;
    };
    fan_curvature(torus.points, {}, options);
    EXPECT_DOUBLE_EQ(last, 1);
    for (const double when : {0.1, 0.5, 0.75, 0.9}) {
        options.orientation = Orientation::mst;
        options.run.progress = [&](double done) { return done < when; };
        EXPECT_THROW(fan_curvature(torus.points, {}, options), Cancelled) << when;
    }
}

TEST(CloudCurvature, RefusesWhatItCannotDo) {
    const Cloud sphere = support::sphere_cloud(1, 20, 21);
    CloudCurvatureOptions options;
    options.k = 2;
    EXPECT_EQ(refusal([&] { fan_curvature(sphere.points, {}, options); }),
              "k = 2 is too small; a fan takes at least 3 neighbours");
    options = fitted(CloudNormals::jet, 5);
    EXPECT_EQ(refusal([&] { fan_curvature(sphere.points, {}, options); }), "degree = 5 is outside 1 to 4");
    options.degree = 0;
    EXPECT_EQ(refusal([&] { fan_curvature(sphere.points, {}, options); }), "degree = 0 is outside 1 to 4");
    EXPECT_EQ(refusal([&] { fan_curvature(sphere.points, Points(sphere.normals.data(), 19)); }),
              "normals has 19 entries, but there are 20 points");
}
