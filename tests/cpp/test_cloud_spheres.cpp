// Algebraic spheres: exact on spheres however irregular the samples, nearly so on cylinders far wider than their
// radius, where the slopes of normals are not; and against differences of the potential, made from the definition. Four
// places side by side: against sums made sample by sample, and the same bits whatever goes along and from every
// instruction set.
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "../../src/algebraic_sphere.h"
#include "../../src/lane_spheres.h"
#include "sphere_reference.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

struct Sample {
    Vec3 p, n;
    double weight;
};

/// The sphere of a place, c + l·y + q |y|² with y from there, from the normal equations as they stand in the
/// definition.
struct Sphere {
    double q, c;
    Vec3 l, place, normal;  ///< mean ones of the samples, the former from the origin
};

Sphere sphere_of(const std::vector<Sample>& samples, Vec3 x) {
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
    return {q, -(dot(l, p) + q * pp) / w, l, x + 1 / w * p, 1 / w * n};
}

double potential(const std::vector<Sample>& samples, Vec3 x) {
    return sphere_of(samples, x).c;
}

double entry(const double (&matrix)[3][3], Vec3 a, Vec3 b) {
    const double as[3] = {a.x, a.y, a.z}, bs[3] = {b.x, b.y, b.z};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += as[i] * matrix[i][j] * bs[j];
    return sum;
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
        EXPECT_NEAR(found.height, 0, 1e-12) << r;
    }
}

TEST(AlgebraicSpheres, TellHowFarTheSurfaceIs) {
    // From a place above the pole of a sphere, along the normal: the potential of a sphere grows as |y|² does.
    constexpr double r = 2, above = 0.1;
    Random random(3);
    SphereSums sums;
    for (const Sample& s : on_sphere(random, r, 40))
        if (const Vec3 p = s.p - Vec3{0, 0, above}; squared(p) < 1) sums.add(p, s.n, s.weight);
    const LevelSet found = sums.level_set();
    EXPECT_NEAR(found.normal.z, 1, 1e-12);
    EXPECT_NEAR(found.height, -((r + above) * (r + above) - r * r) / (2 * (r + above)), 1e-12);
}

TEST(AlgebraicSpheres, TellWhereTheSamplesAre) {
    // Of an even half disc it is at (4 / 3π) · (24 / 35) = 0.291 from the middle of the disc.
    SphereSums sums;
    for (int i = 0; i < 100; ++i)
        for (int j = -99; j < 100; ++j)
            if (const Vec3 p = {0.01 * i + 0.005, 0.01 * j, 0}; squared(p) < 1) sums.add(p, {0, 0, 1}, 0.3);
    EXPECT_NEAR(sums.middle().x, 4 / (3 * std::numbers::pi) * 24 / 35, 1e-3);
    EXPECT_NEAR(sums.middle().y, 0, 1e-12);
    EXPECT_EQ(sums.middle().z, 0);
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
    const SphereSums sums = sums_of(samples);
    const LevelSet found = sums.level_set();
    EXPECT_NEAR(length(found.normal - unit(g)), 0, 1e-5);
    // A step of Newton's towards the surface.
    EXPECT_NEAR(found.height, -f({0, 0, 0}) / length(g), 1e-5);
    // The slope of the mean normal over the mean place.
    double turn[3][3], move[3][3];
    for (int b = 0; b < 3; ++b) {
        const Sphere after = sphere_of(samples, step * axes[b]), before = sphere_of(samples, -step * axes[b]);
        const Vec3 n = 1 / (2 * step) * (after.normal - before.normal),
                   m = 1 / (2 * step) * (after.place - before.place);
        turn[0][b] = n.x, turn[1][b] = n.y, turn[2][b] = n.z;
        move[0][b] = m.x, move[1][b] = m.y, move[2][b] = m.z;
    }
    const Frame frame = frame_about(unit(g));
    const Vec3 in_frame[2] = {frame.u, frame.v};
    const double m00 = entry(move, frame.u, frame.u), m01 = entry(move, frame.u, frame.v),
                 m10 = entry(move, frame.v, frame.u), m11 = entry(move, frame.v, frame.v);
    const double det = m00 * m11 - m01 * m10;
    double slope[2][2];
    for (int a = 0; a < 2; ++a) {
        // Row a of the slope times the changes of the place is that of the changes of the normal.
        const double n0 = entry(turn, in_frame[a], frame.u), n1 = entry(turn, in_frame[a], frame.v);
        slope[a][0] = (n0 * m11 - n1 * m10) / det, slope[a][1] = (n1 * m00 - n0 * m01) / det;
    }
    const Vec3 mean = sphere_of(samples, {0, 0, 0}).place;
    const double part = length(mean - dot(mean, unit(g)) * unit(g)) / 0.6;
    EXPECT_GT(part, 0.02) << "uneven enough to see it";
    for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
            const double second = entry(hessian, in_frame[a], in_frame[b]) / length(g),
                         slopes = 0.5 * (slope[a][b] + slope[b][a]) / length(g);
            EXPECT_NEAR(dot(in_frame[a], product(found.tensor, in_frame[b])), (1 - part) * second + part * slopes, 1e-4)
                << a << b;
        }
    EXPECT_NEAR(length(product(found.tensor, found.normal)), 0, 1e-12);
}

TEST(AlgebraicSpheres, SeeMoreThanTheirPotentialAtTheBorderOfASaddle) {
    // The normals are linear over the place, of a minimal surface: nothing of it is a sphere. Second derivatives of the
    // potential alone see half of the density at the border.
    constexpr double bend = 0.05, step = 0.01;
    SphereSums whole, half;
    std::vector<Sample> beside;
    for (int i = -99; i < 100; ++i)
        for (int j = -99; j < 100; ++j) {
            const double u = 0.01 * i + 0.005, v = 0.01 * j;
            const Vec3 p = {u, v, 0.5 * bend * (u * u - v * v)}, n = unit(Vec3{-bend * u, bend * v, 1});
            if (squared(p) >= 1) continue;
            whole.add(p, n, 1);
            if (u > 0) half.add(p, n, 1), beside.push_back({p, n, 1});
        }
    const auto second = [&](Vec3 along) {
        return (potential(beside, step * along) - 2 * potential(beside, {0, 0, 0}) + potential(beside, -step * along)) /
               (step * step);
    };
    const double truth = 2 * bend * bend;
    EXPECT_NEAR(squared_norm(whole.level_set().tensor), truth, 0.01 * truth);
    EXPECT_LT(std::pow(second({1, 0, 0}), 2) + std::pow(second({0, 1, 0}), 2), 0.51 * truth);
    EXPECT_GT(squared_norm(half.level_set().tensor), 0.6 * truth);
    EXPECT_LT(squared_norm(half.level_set().tensor), truth);
}

TEST(AlgebraicSpheres, TooFewSamplesTellNothing) {
    SphereSums one;
    one.add({0, 0, 0}, {0, 0, 1}, 1);
    EXPECT_FALSE(std::isfinite(one.level_set().normal.z));
    EXPECT_FALSE(std::isfinite(SphereSums().level_set().normal.z));
}

namespace {

constexpr int count = 41;  // odd: two go at a time
constexpr double radius = 0.6;

/// About the pole of a unit sphere, with noise, normals of either side, and some that must not count.
std::vector<SphereSample> samples_about_the_pole(Random& random) {
    std::vector<SphereSample> samples(count);
    for (SphereSample& sample : samples) {
        const double u = 0.8 * (random.uniform() - 0.5), v = 0.8 * (random.uniform() - 0.5);
        const Vec3 foot = {u, v, std::sqrt(1 - u * u - v * v) + 0.01 * random.normal()};
        const Vec3 off = {0.05 * random.normal(), 0.05 * random.normal(), 0};
        const Vec3 normal = (random.below(2) == 0 ? 1.0 : -1.0) * unit(foot + off);
        sample = {{normal.x, normal.y, normal.z}, {foot.x, foot.y, foot.z}, 0.2 + random.uniform()};
    }
    samples[3] = {};                                                            // nothing is known there
    samples[4].normal[0] = 1, samples[4].normal[1] = samples[4].normal[2] = 0;  // upright
    for (double& x : samples[5].foot) x += 1;                                   // far away
    samples[6] = {{0, 0, -1}, {0.1, 0, 0.6}, 1};                                // across
    samples[10] = {{0, 0, 1}, {0.02, 0.03, 1.04}, 1};                           // overhead, but near by
    return samples;
}

std::vector<std::int32_t> rows() {
    std::vector<std::int32_t> row(count);
    for (int s = 0; s < count; ++s) row[static_cast<std::size_t>(s)] = s % 10 == 7 ? -1 : s;
    return row;
}

void set_ball(LaneBalls& balls, int lane, const std::vector<std::int32_t>& row, Vec3 normal, Vec3 at) {
    balls.set(lane, frame_about(normal), at);
    balls.radius[lane] = radius;
    balls.samples[lane] = row.data();
    balls.count = count;
}

std::vector<LaneSphereKernel*> kernels() {
    std::vector<LaneSphereKernel*> found = {lane_spheres_baseline};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) found.push_back(lane_spheres_avx2);
#endif
    return found;
}

}  // namespace

TEST(LaneSpheres, AreThoseOfPlainSums) {
    Random random(4);
    const std::vector<SphereSample> samples = samples_about_the_pole(random);
    const std::vector<std::int32_t> row = rows();
    const Vec3 normal = unit(Vec3{0.1, -0.05, 1}), at = {0.02, 0.03, 1};
    const Frame frame = frame_about(normal);
    const auto seen = [&](Vec3 d) { return Vec3{dot(d, frame.u), dot(d, frame.v), dot(d, frame.n)}; };
    SphereSums sums;
    int counted = 0;
    for (const std::int32_t s : row) {
        if (s < 0) continue;
        const SphereSample& sample = samples[static_cast<std::size_t>(s)];
        const Vec3 d = seen(1 / radius * (load(sample.foot) - at)), its = seen(load(sample.normal));
        if (!support::add_if_seen(sums, d, its, {0, 0, 1}, sample.weight)) continue;
        EXPECT_NE(s, 6) << "across";
        ++counted;
    }
    EXPECT_GE(counted, 20);
    EXPECT_LT(counted, count - 5);
    for (LaneSphereKernel* kernel : kernels()) {
        LaneBalls balls;
        for (const int lane : {0, 2, 3}) set_ball(balls, lane, row, normal, at);  // and none in one lane
        LaneSpheres spheres;
        kernel(samples.data(), balls, spheres);
        for (int t = 0; t < SphereSums::terms; ++t)
            for (int i = 0; i < SphereSums::parts; ++i) {
                for (const int lane : {0, 2, 3}) EXPECT_NEAR(spheres.sums(lane).sum[t][i], sums.sum[t][i], 1e-12);
                EXPECT_EQ(spheres.sum[t][i][1], 0);
            }
    }
}

TEST(LaneSpheres, TakeUnorientedNormalsRoundATube) {
    // About a place of a cylinder, all samples within 84 degrees count, however steep, with the side of a tube; the far
    // half does not. So the level set is exact across, as that of normals that have a side.
    constexpr double tube = 0.3;
    Random random(6);
    std::vector<SphereSample> samples(400);
    std::vector<std::int32_t> row;
    SphereSums sums;
    for (SphereSample& sample : samples) {
        const double angle = 2 * std::numbers::pi * random.uniform(), y = 0.4 * (random.uniform() - 0.5);
        const Vec3 normal = {std::sin(angle), 0, std::cos(angle)}, foot = {tube * normal.x, y, tube * normal.z - tube};
        const double side = random.below(2) == 0 ? 1 : -1;
        sample = {{side * normal.x, 0, side * normal.z}, {foot.x, foot.y, foot.z}, 1};
        row.push_back(static_cast<std::int32_t>(row.size()));
        if (normal.z >= same_half && squared(1 / radius * foot) < 1) sums.add(1 / radius * foot, normal, 1);
    }
    for (LaneSphereKernel* kernel : kernels()) {
        LaneBalls balls;
        set_ball(balls, 0, row, {0, 0, 1}, {0, 0, 0});
        balls.count = static_cast<int>(row.size());
        const Frame frame = frame_about({0, 0, 1});
        LaneSpheres spheres;
        kernel(samples.data(), balls, spheres);
        const LevelSet found = spheres.sums(0).level_set(), truth = sums.level_set();
        EXPECT_NEAR(spheres.sums(0).sum[0][0], sums.sum[0][0], 1e-9);
        EXPECT_NEAR(squared_norm(found.tensor), squared_norm(truth.tensor), 1e-9);
        const Vec3 across = {dot({1, 0, 0}, frame.u), dot({1, 0, 0}, frame.v), 0};
        EXPECT_NEAR(dot(across, product(found.tensor, across)) / radius, 1 / tube, 0.05 / tube);
    }
}

TEST(LaneSpheres, StandAloneWithTheSameBitsFromEveryInstructionSet) {
    Random random(5);
    const std::vector<SphereSample> samples = samples_about_the_pole(random);
    const std::vector<std::int32_t> row = rows(), nothing(count, -1);
    const Vec3 at = {0.02, 0.03, 1};
    LaneBalls alike, mixed;
    for (int l = 0; l < fit_lanes; ++l) {
        set_ball(alike, l, row, {0, 0, 1}, at);
        set_ball(mixed, l, l == 1 ? nothing : row, l == 2 ? Vec3{NAN, NAN, NAN} : Vec3{0, 0, 1}, at);
    }
    LaneSpheres first;
    lane_spheres_baseline(samples.data(), alike, first);
    for (LaneSphereKernel* kernel : kernels()) {
        LaneSpheres again, among;
        kernel(samples.data(), alike, again);
        kernel(samples.data(), mixed, among);
        EXPECT_EQ(std::memcmp(&first, &again, sizeof first), 0);
        for (int t = 0; t < SphereSums::terms; ++t)
            for (const int l : {0, 3}) EXPECT_EQ(among.sum[t][5][l], first.sum[t][5][l]);
        for (const int l : {1, 2}) EXPECT_EQ(among.sum[0][4][l], 0);
    }
}
