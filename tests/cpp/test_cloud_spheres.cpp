// Algebraic spheres: exact on spheres however irregular the samples, nearly so on cylinders far wider than their
// radius, where the slopes of normals are not; and against differences of the potential, made from the definition.
#include <cmath>
#include <vector>

#include "../../src/algebraic_sphere.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

struct Sample {
    Vec3 p, n;
    double weight;
};

/// The value at x of the sphere of x, from the normal equations as they stand in the definition.
double potential(const std::vector<Sample>& samples, Vec3 x) {
    double w = 0, pp = 0, pn = 0;
    Vec3 p = {0, 0, 0}, n = {0, 0, 0};
    for (const Sample& s : samples) {
        const Vec3 d = s.p - x;
        const double r = 1 - squared(d), weight = r > 0 ? s.weight * r * r : 0;
        w += weight, p = p + weight * d, n = n + weight * s.n;
        pp += weight * squared(d), pn += weight * dot(d, s.n);
    }
    const double q = 0.5 * (pn - dot(p, n) / w) / (pp - dot(p, p) / w);
    const Vec3 l = 1 / w * (n - 2 * q * p);
    return -(dot(l, p) + q * pp) / w;
}

SphereSums sums_of(const std::vector<Sample>& samples) {
    SphereSums sums;
    for (const Sample& s : samples)
        if (squared(s.p) < 1) sums.add(s.p, s.n, s.weight);
    return sums;
}

/// All of a sphere of radius r below its pole at the origin that is within reach, unevenly.
std::vector<Sample> on_sphere(Random& random, double r, int count) {
    std::vector<Sample> samples;
    while (static_cast<int>(samples.size()) < count) {
        const Vec3 n = unit(Vec3{random.normal() + 0.5, random.normal(), random.normal() + 1});
        const Vec3 p = r * (n - Vec3{0, 0, 1});
        if (squared(p) < 1) samples.push_back({p, n, 0.1 + random.uniform()});
    }
    return samples;
}

}  // namespace

TEST(AlgebraicSpheres, AreExactOnSpheres) {
    Random random(1);
    for (const double r : {0.55, 1.0, 4.0}) {
        const LevelSet found = sums_of(on_sphere(random, r, 12)).level_set();
        EXPECT_NEAR(found.normal.z, 1, 1e-12) << r;
        EXPECT_NEAR(found.tensor.xx, 1 / r, 1e-9 / r) << r;
        EXPECT_NEAR(found.tensor.yy, 1 / r, 1e-9 / r) << r;
        EXPECT_NEAR(found.tensor.xy, 0, 1e-9 / r) << r;
        EXPECT_NEAR(squared_norm(found.tensor), 2 / (r * r), 1e-8 / (r * r)) << r;
    }
}

TEST(AlgebraicSpheres, FollowCylindersFarRound) {
    // The window reaches 60 degrees along the circle.
    constexpr double r = 0.95;
    std::vector<Sample> samples;
    for (int i = -60; i <= 60; ++i)
        for (int j = -40; j <= 40; ++j) {
            const double angle = i * 0.02, y = j * 0.025;
            samples.push_back(
                {{r * std::sin(angle), y, r * (std::cos(angle) - 1)}, {std::sin(angle), 0, std::cos(angle)}, 1});
        }
    const LevelSet found = sums_of(samples).level_set();
    EXPECT_NEAR(found.tensor.xx, 1 / r, 0.02 / r);
    EXPECT_NEAR(found.tensor.yy, 0, 0.02 / r);
}

TEST(AlgebraicSpheres, AreTheDerivativesOfThePotential) {
    Random random(2);
    std::vector<Sample> samples;
    for (int i = 0; i < 80; ++i) {
        // A saddle with noise in places and normals.
        const double u = 1.6 * random.uniform() - 0.8, v = 1.6 * random.uniform() - 0.8;
        const Vec3 n = unit(Vec3{-0.6 * u + 0.05 * random.normal(), 0.9 * v + 0.05 * random.normal(), 1});
        samples.push_back({{u, v, 0.3 * u * u - 0.45 * v * v + 0.02 * random.normal()}, n, 0.2 + random.uniform()});
    }
    constexpr double step = 1e-3;
    constexpr Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const auto f = [&](Vec3 x) { return potential(samples, x); };
    double gradient[3], hessian[3][3];
    for (int a = 0; a < 3; ++a) {
        gradient[a] = (f(step * axes[a]) - f(-step * axes[a])) / (2 * step);
        for (int b = 0; b < 3; ++b)
            hessian[a][b] = (f(step * (axes[a] + axes[b])) - f(step * (axes[a] - axes[b])) -
                             f(step * (axes[b] - axes[a])) + f(-step * (axes[a] + axes[b]))) /
                            (4 * step * step);
    }
    const Vec3 g = {gradient[0], gradient[1], gradient[2]};
    const LevelSet found = sums_of(samples).level_set();
    EXPECT_NEAR(length(found.normal - unit(g)), 0, 1e-5);
    const Frame frame = frame_about(unit(g));
    const auto curvature = [&](Vec3 a, Vec3 b) {
        const double as[3] = {a.x, a.y, a.z}, bs[3] = {b.x, b.y, b.z};
        double sum = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) sum += as[i] * hessian[i][j] * bs[j];
        return sum / length(g);
    };
    EXPECT_NEAR(dot(frame.u, product(found.tensor, frame.u)), curvature(frame.u, frame.u), 1e-4);
    EXPECT_NEAR(dot(frame.u, product(found.tensor, frame.v)), curvature(frame.u, frame.v), 1e-4);
    EXPECT_NEAR(dot(frame.v, product(found.tensor, frame.v)), curvature(frame.v, frame.v), 1e-4);
    EXPECT_NEAR(length(product(found.tensor, found.normal)), 0, 1e-12);
}

TEST(AlgebraicSpheres, TooFewSamplesTellNothing) {
    SphereSums one;
    one.add({0, 0, 0}, {0, 0, 1}, 1);
    EXPECT_FALSE(std::isfinite(one.level_set().normal.z));
    EXPECT_FALSE(std::isfinite(SphereSums().level_set().normal.z));
}
