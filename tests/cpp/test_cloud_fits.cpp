// Curvature of clouds by jets and by regression of normals: exact cases, orders, what must not change them, messages.
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

CloudCurvatureOptions jet(int degree, int k = 20) {
    CloudCurvatureOptions options;
    options.estimator = Estimator::jet;
    options.degree = degree;
    options.k = k;
    options.tensor = options.confidence = true;
    return options;
}

CloudCurvatureOptions regression(int k = 20) {
    CloudCurvatureOptions options = jet(4, k);
    options.estimator = Estimator::regression;
    return options;
}

double largest_relative_error(const std::vector<double>& value, const std::vector<double>& truth) {
    double largest = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double error = std::abs(value[i] - truth[i]) / truth[i];
        largest = error <= largest ? largest : error;  // NaN stays
    }
    return largest;
}

/// Of the graph z = au² + buv + cv² and an even quartic: points come in pairs ±(u, v), the origin is the last.
Cloud graph(double a, double b, double c, double quartic, int pairs, std::uint64_t seed) {
    Random random(seed);
    Cloud cloud;
    const auto add = [&](double u, double v) {
        const double z = a * u * u + b * u * v + c * v * v + quartic * (u * u * u * u - 2 * u * v * v * v);
        cloud.add({u, v, z}, {0, 0, 1}, 4 * a * a + 2 * b * b + 4 * c * c);
    };
    for (int i = 0; i < pairs; ++i) {
        const double u = 0.6 * random.uniform() - 0.3, v = 0.6 * random.uniform() - 0.3;
        add(u, v);
        add(-u, -v);
    }
    add(0, 0);
    return cloud;
}

/// Part of the values whose truth lies within two standard errors.
double covered(const CloudCurvature& result, const std::vector<double>& truth) {
    std::size_t within = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        within += std::abs(result.density[i] - truth[i]) <= 2 * result.error[i];
    return static_cast<double>(within) / static_cast<double>(truth.size());
}

std::vector<double> scaled(std::vector<double> values, double by) {
    for (double& v : values) v *= by;
    return values;
}

}  // namespace

TEST(CloudFits, RegressionIsExactOnSpheresAndCylinders) {
    for (const double radius : {1.0, 0.003, 5e4})
        for (const int k : {3, 8, 20, 60}) {
            const Cloud sphere = support::sphere_cloud(radius, 2000, 1);
            const CloudCurvature result = cloud_curvature(sphere.points, sphere.normals, regression(k));
            EXPECT_LT(largest_relative_error(result.density, sphere.density), k == 3 ? 1e-9 : 1e-12) << k;
            EXPECT_LT(largest_relative_error(result.tensor.k2, std::vector<double>(2000, 1 / radius)), 1e-9);
        }
    const Cloud cylinder = support::cylinder_cloud(0.5, 2, 0.05, 2);
    const CloudCurvature result = cloud_curvature(cylinder.points, cylinder.normals, regression());
    EXPECT_LT(largest_relative_error(result.density, cylinder.density), 1e-12);
    for (std::size_t i = 0; i < cylinder.count(); ++i) {
        ASSERT_NEAR(result.tensor.k1[i], 2, 1e-12);
        ASSERT_NEAR(result.tensor.k2[i], 0, 1e-12);
        ASSERT_NEAR(result.tensor.direction[3 * i + 2], 0, 1e-10) << "around, not along";
        ASSERT_LT(result.error[i], 1e-6) << "residuals come from differences of sums of squares";
    }
}

TEST(CloudFits, JetsAreExactOnPolynomialsOfTheirDegree) {
    Random random(3);
    for (const int degree : {2, 3, 4}) {
        const Cloud cloud = graph(0.7, -0.4, 0.2, degree == 4 ? 1.5 : 0, 20, 4);
        const std::size_t origin = cloud.count() - 1;
        const std::vector<double> points = support::times(support::random_rotation(random), cloud.points);
        const CloudCurvature result = cloud_curvature(points, {}, jet(degree, 40));
        EXPECT_NEAR(result.density[origin], cloud.density[origin], 1e-10);
        EXPECT_LT(result.error[origin], 1e-5) << "residuals come from differences of sums of squares";
        const double mean = -0.9, half = std::hypot(0.5, 0.4);  // of −(2a, b; b, 2c)
        const double sign = result.tensor.k1[origin] + result.tensor.k2[origin] < 0 ? 1 : -1;
        EXPECT_NEAR(result.tensor.k1[origin], sign * mean + half, 1e-10);
        EXPECT_NEAR(result.tensor.k2[origin], sign * mean - half, 1e-10);
    }
    const Cloud quartic = graph(0.7, -0.4, 0.2, 1.5, 20, 4);
    const CloudCurvature low = cloud_curvature(quartic.points, {}, jet(2, 40));
    EXPECT_GT(std::abs(low.density.back() - quartic.density.back()), 1e-3) << "a quadric is no quartic";
    EXPECT_GT(low.error.back(), 1e-3);
}

TEST(CloudFits, OrdersOnATorus) {
    struct Case {
        CloudCurvatureOptions options;
        bool normals;
        double order, finest;
    };
    // Irregular points: the error of second derivatives is of the order degree − 1, of the first of normals 2.
    const Case cases[] = {{jet(2, 10), false, 1, 0.012},    {jet(3, 14), false, 2, 0.005},
                          {jet(4, 20), false, 3, 2e-4},     {regression(8), true, 2, 0.0015},
                          {regression(20), true, 2, 0.003}, {regression(20), false, 2, 0.003}};
    for (const Case& c : cases) {
        double before = 0;
        for (const double step : {0.1, 0.05, 0.025}) {
            const Cloud torus = support::torus_cloud(1, 0.5, step, 2);
            const Points normals = c.normals ? Points(torus.normals) : Points();
            const CloudCurvature result = cloud_curvature(torus.points, normals, c.options);
            const double error = relative_rmse(result.density, torus.density);
            EXPECT_EQ(result.undefined + result.lowered, 0u);
            if (before > 0) { EXPECT_GT(before / error, 0.9 * std::exp2(c.order)) << c.options.degree; }
            before = error;
        }
        EXPECT_LT(before, c.finest) << estimator_name(c.options.estimator) << " " << c.options.degree;
    }
}

TEST(CloudFits, Ellipsoid) {
    const Cloud ellipsoid = support::ellipsoid_cloud(1, 0.8, 0.6, 10000, 3);
    EXPECT_LT(relative_rmse(cloud_curvature(ellipsoid.points, {}, jet(4)).density, ellipsoid.density), 5e-4);
    EXPECT_LT(
        relative_rmse(cloud_curvature(ellipsoid.points, ellipsoid.normals, regression()).density, ellipsoid.density),
        0.01);
}

TEST(CloudFits, Invariances) {
    Random random(7);
    const Cloud torus = support::torus_cloud(1, 0.5, 0.08, 8);
    std::vector<double> coarse = torus.points;
    for (double& x : coarse) x = std::ldexp(std::round(std::ldexp(x, 24)), -24);
    std::vector<double> far = coarse;
    for (double& x : far) x += 0x1p22;  // over 10⁶ diagonals away
    std::vector<std::size_t> order(torus.count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    std::vector<double> shuffled(coarse.size());
    for (std::size_t i = 0; i < order.size(); ++i) std::copy_n(&coarse[3 * order[i]], 3, &shuffled[3 * i]);
    const std::vector<double> rotation = support::random_rotation(random), turned = support::times(rotation, coarse);
    const std::vector<double> large = scaled(coarse, 1024), down = scaled(torus.normals, -3);
    for (const CloudCurvatureOptions& options : {jet(2), jet(3), jet(4), regression()}) {
        const CloudCurvature here = cloud_curvature(coarse, {}, options);
        EXPECT_TRUE(support::same_bits(cloud_curvature(far, {}, options).density, here.density));
        EXPECT_TRUE(support::same_bits(cloud_curvature(large, {}, options).density, scaled(here.density, 0x1p-20)));
        EXPECT_TRUE(support::same_bits(cloud_curvature(large, {}, options).error, scaled(here.error, 0x1p-20)));
        EXPECT_LT(largest_relative_error(cloud_curvature(turned, {}, options).density, here.density), 1e-6);
        const CloudCurvature mixed = cloud_curvature(shuffled, {}, options);
        for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(mixed.density[i], here.density[order[i]]);

        const CloudCurvature out = cloud_curvature(coarse, torus.normals, options);
        const CloudCurvature in = cloud_curvature(coarse, down, options);
        for (std::size_t i = 0; i < torus.count(); ++i) {
            ASSERT_NEAR(in.density[i], out.density[i], 1e-9 * out.density[i]);
            ASSERT_NEAR(in.tensor.k1[i], -out.tensor.k2[i], 1e-9);
            ASSERT_GT(support::dot3(&out.normals[3 * i], &torus.normals[3 * i]), 0.99);
            ASSERT_LT(support::dot3(&in.normals[3 * i], &torus.normals[3 * i]), -0.99);
            ASSERT_NEAR(out.tensor.k1[i], 2, 0.3) << "positive where the surface bends away from its normal";
        }
    }
}

TEST(CloudFits, SameBitsForAnyNumberOfThreads) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.06, 5);
    for (CloudCurvatureOptions options : {jet(4), regression()}) {
        options.run.threads = 1;
        const CloudCurvature one = cloud_curvature(torus.points, {}, options);
        for (const int threads : {2, 7}) {
            options.run.threads = threads;
            const CloudCurvature many = cloud_curvature(torus.points, {}, options);
            EXPECT_TRUE(support::same_bits(one.density, many.density));
            EXPECT_TRUE(support::same_bits(one.error, many.error));
            EXPECT_TRUE(support::same_bits(one.normals, many.normals));
            EXPECT_TRUE(support::same_bits(one.tensor.direction, many.tensor.direction));
        }
    }
}

TEST(CloudFits, WhatIsUndefinedIsCounted) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Cloud sphere = support::sphere_cloud(1, 500, 6);
    for (const int at : {3, 7})
        sphere.add({sphere.points[3 * at], sphere.points[3 * at + 1], sphere.points[3 * at + 2]}, {0, 0, 1}, 2);
    sphere.add({nan, 0, 0}, {0, 0, 1}, 2);
    const std::vector<double> line = {0, 0, 0, 1, 1, 0, 2, 2, 0, 3, 3, 0, 4, 4, 0, 5, 5, 0, 6, 6, 0};
    const std::vector<double> side = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    const std::vector<double> single = {1, 2, 3};
    for (const CloudCurvatureOptions& options : {jet(4), regression()}) {
        const CloudCurvature result = cloud_curvature(sphere.points, sphere.normals, options);
        EXPECT_EQ(result.duplicates, 2u);
        EXPECT_EQ(result.non_finite, 1u);
        EXPECT_EQ(result.undefined, 1u);
        EXPECT_TRUE(std::isnan(result.density.back()) && std::isnan(result.error.back()));
        EXPECT_EQ(result.density[500], result.density[3]);
        EXPECT_EQ(result.error[501], result.error[7]);
        EXPECT_EQ(result.tensor.k1[501], result.tensor.k1[7]);
        EXPECT_TRUE(result.choice.empty());
        EXPECT_EQ(cloud_curvature(line, {}, options).undefined, 7u);
        EXPECT_EQ(cloud_curvature(line, side, options).undefined, 7u) << "one direction says nothing of the other";
        EXPECT_EQ(cloud_curvature({}, {}, options).undefined, 0u);
        EXPECT_EQ(cloud_curvature(single, {}, options).undefined, 1u);
    }
    // Nine points have eight neighbours: enough for a quadric alone. Five have four: enough for nothing.
    const Cloud nine = support::sphere_cloud(1, 9, 9), five = support::sphere_cloud(1, 5, 9);
    const CloudCurvature few = cloud_curvature(nine.points, {}, jet(4));
    EXPECT_EQ(few.lowered, 9 - few.undefined);
    EXPECT_EQ(cloud_curvature(five.points, {}, jet(4)).undefined, 5u);
    const CloudCurvature linear = cloud_curvature(five.points, five.normals, regression());
    EXPECT_EQ(linear.lowered, 5u);
    EXPECT_LT(largest_relative_error(linear.density, five.density), 1e-9);
}

TEST(CloudFits, ConfidenceUnderNoise) {
    Random random(5);
    const Cloud torus = support::torus_cloud(1, 0.5, 0.04, 2);
    std::vector<double> points = torus.points, normals = torus.normals;
    for (double& x : normals) x += 0.02 * random.normal();
    for (std::size_t i = 0; i < torus.count(); ++i) {
        const double along = 3e-4 * random.normal();
        for (std::size_t c = 0; c < 3; ++c) points[3 * i + c] += along * torus.normals[3 * i + c];
    }
    for (const int degree : {2, 3, 4}) {
        const double part = covered(cloud_curvature(points, {}, jet(degree, 30)), torus.density);
        EXPECT_GT(part, 0.8) << degree;
    }
    for (const int k : {10, 20})
        EXPECT_GT(covered(cloud_curvature(torus.points, normals, regression(k)), torus.density), 0.8);
    // Not by being large: relative to what the errors are, the standard error is neither tiny nor huge.
    const CloudCurvature quadric = cloud_curvature(points, {}, jet(2, 30));
    std::vector<double> ratio;
    for (std::size_t i = 0; i < torus.count(); ++i)
        ratio.push_back(std::abs(quadric.density[i] - torus.density[i]) / quadric.error[i]);
    std::nth_element(ratio.begin(), ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2), ratio.end());
    EXPECT_GT(ratio[ratio.size() / 2], 0.3);
    EXPECT_LT(ratio[ratio.size() / 2], 1.2);
}

TEST(CloudFits, Messages) {
    const Cloud sphere = support::sphere_cloud(1, 50, 1);
    EXPECT_EQ(refusal([&] { cloud_curvature(sphere.points, {}, jet(1)); }),
              "degree = 1 has no curvature; estimator = jet takes 2 to 4");
    EXPECT_EQ(refusal([&] { cloud_curvature(sphere.points, {}, jet(5)); }), "degree = 5 is outside 1 to 4");
    EXPECT_EQ(refusal([&] { cloud_curvature(sphere.points, {}, jet(2, 4)); }),
              "k = 4 is too small; estimator = jet takes at least 5 neighbours");
}
