// Averages about four elements side by side: against sums made sample by sample with tensors turned in space, on
// samples of a bumpy surface with some that must not count; the same bits whatever goes along and from every
// instruction set. Slopes with a free constant against normal equations of six unknowns.
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "../../src/lane_averages.h"
#include "../../src/shape_tensor.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

constexpr int count = 41;  // odd: two go at a time
constexpr double half = 0.35, whole = 0.6;

Vec3 random_unit(Random& random) {
    return unit(Vec3{random.normal(), random.normal(), random.normal()});
}

/// About the pole of a unit sphere, with noise in everything; normals of either side, with the tensors' signs.
std::vector<SurfaceSample> samples_about_the_pole(Random& random) {
    std::vector<SurfaceSample> samples(count);
    for (SurfaceSample& sample : samples) {
        const double u = 0.8 * (random.uniform() - 0.5), v = 0.8 * (random.uniform() - 0.5),
                     side = random.below(2) == 0 ? 1 : -1;
        const Vec3 foot = {u, v, std::sqrt(1 - u * u - v * v) + 0.01 * random.normal()};
        const Vec3 normal = side * unit(foot + 0.05 * random_unit(random));
        const Frame frame = frame_about(normal);
        Symmetric3 t;
        add_product(t, side * (1 + 0.2 * random.normal()), frame.u, frame.u);
        add_product(t, side * 0.2 * random.normal(), frame.u, frame.v);
        add_product(t, side * (1 + 0.2 * random.normal()), frame.v, frame.v);
        sample = {{normal.x, normal.y, normal.z},
                  {foot.x, foot.y, foot.z},
                  {t.xx, t.xy, t.xz, t.yy, t.yz, t.zz},
                  0.2 + random.uniform()};
    }
    samples[3] = {};                                                              // nothing is known there
    for (double& n : samples[4].normal) n = &n == &samples[4].normal[0] ? 1 : 0;  // upright
    for (double& x : samples[5].foot) x += 1;                                     // far away
    samples[6].foot[0] = 0.4, samples[6].foot[1] = 0, samples[6].foot[2] = 0.92;  // in the wide window alone
    return samples;
}

std::vector<std::int32_t> rows() {
    std::vector<std::int32_t> row(count);
    for (int s = 0; s < count; ++s) row[static_cast<std::size_t>(s)] = s % 10 == 7 ? -1 : s;
    return row;
}

void centre(LaneCentres& centres, int lane, const std::vector<std::int32_t>& row, Vec3 normal, Vec3 foot) {
    centres.set(lane, frame_about(normal), foot);
    centres.unit[lane] = 1 / whole;
    centres.reach[0][lane] = half * half, centres.reach[1][lane] = whole * whole;
    centres.samples[lane] = row.data();
    centres.count = count;
}

std::vector<LaneAverageKernel*> kernels() {
    std::vector<LaneAverageKernel*> found = {lane_averages_baseline};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) found.push_back(lane_averages_avx2);
#endif
    return found;
}

Symmetric3 tensor_of(const SurfaceSample& s) {
    return {s.tensor[0], s.tensor[1], s.tensor[2], s.tensor[3], s.tensor[4], s.tensor[5]};
}

/// Slopes of a fit whose constant is a sixth unknown, and the covariance of the linear part, by normal equations
/// inverted as they stand. The element itself is the first datum, at place 0 with normal 0.
struct PlainFit {
    double s[2][2], covariance[2][2], residual;
};
PlainFit plain_fit(const std::vector<std::array<double, 5>>& data) {
    constexpr int terms = 6;
    double a[terms][2 * terms + 2] = {}, square = 0, explained = 0;  // with the two sides and the unit matrix
    const auto at = [](const std::array<double, 5>& d) {
        return std::array<double, terms>{d[0], d[1], d[0] * d[0], d[0] * d[1], d[1] * d[1], 1};
    };
    double sides[terms][2] = {};
    for (const auto& d : data) {
        const auto m = at(d);
        for (int i = 0; i < terms; ++i) {
            for (int j = 0; j < terms; ++j) a[i][j] += d[4] * m[i] * m[j];
            for (int c = 0; c < 2; ++c) sides[i][c] += d[4] * m[i] * d[2 + c];
        }
        square += d[4] * (d[2] * d[2] + d[3] * d[3]);
    }
    for (int i = 0; i < terms; ++i) {
        a[i][terms] = sides[i][0], a[i][terms + 1] = sides[i][1];
        a[i][terms + 2 + i] = 1;
    }
    for (int p = 0; p < terms; ++p) {
        const double pivot = a[p][p];
        for (double& x : a[p]) x /= pivot;
        for (int i = 0; i < terms; ++i) {
            const double factor = i == p ? 0 : a[i][p];
            for (int j = 0; j < 2 * terms + 2; ++j) a[i][j] -= factor * a[p][j];
        }
    }
    PlainFit fit;
    for (int i = 0; i < terms; ++i)
        for (int c = 0; c < 2; ++c) explained += a[i][terms + c] * sides[i][c];
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) fit.s[i][j] = a[j][terms + i], fit.covariance[i][j] = a[i][terms + 2 + j];
    fit.residual = square - explained;
    return fit;
}

}  // namespace

TEST(SlopeFit, LetFreeIsTheFitWithAConstant) {
    Random random(3);
    // Over half a disc, where the constant matters.
    std::vector<std::array<double, 5>> data = {{0, 0, 0, 0, 0.3}};
    SlopeFit slopes;
    double weights = 0, normals[2] = {};
    for (int i = 0; i < 60; ++i) {
        const double u = random.uniform(), v = 2 * random.uniform() - 1, weight = 0.1 + random.uniform();
        const double nu = 0.1 + 0.5 * u - 0.2 * v + 0.05 * random.normal(), nv = 0.7 * v + 0.05 * random.normal();
        data.push_back({u, v, nu, nv, weight});
        slopes.add(u, v, nu, nv, weight);
        weights += weight, normals[0] += weight * nu, normals[1] += weight * nv;
    }
    Slopes through, fit;
    ASSERT_TRUE(slopes.solve<5>(through));
    slopes.let_free(0.3, weights, normals);
    ASSERT_TRUE(slopes.solve<5>(fit));
    const PlainFit truth = plain_fit(data);
    EXPECT_NEAR(fit.residual, truth.residual, 1e-10);
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(fit.shift[i], 0);
        for (int j = 0; j < 2; ++j) {
            EXPECT_NEAR(fit.s[i][j], truth.s[i][j], 1e-10);
            EXPECT_NEAR(fit.covariance[i][j], truth.covariance[i][j], 1e-10);
        }
    }
    // The element's own normal is off by 0.1: a fit through it is tilted by that, a free one is not.
    EXPECT_GT(std::abs(through.s[0][0] - 0.5), 0.15);
    EXPECT_LT(std::abs(fit.s[0][0] - 0.5), 0.15);
}

TEST(LaneAverages, AreThoseOfPlainSums) {
    Random random(1);
    const std::vector<SurfaceSample> samples = samples_about_the_pole(random);
    const std::vector<std::int32_t> row = rows();
    const Vec3 normal = unit(Vec3{0.1, -0.05, 1}), at = {0.02, 0.03, 1};
    const Frame frame = frame_about(normal);
    for (LaneAverageKernel* kernel : kernels()) {
        LaneCentres centres;
        for (const int lane : {0, 2, 3}) centre(centres, lane, row, normal, at);  // and none in one lane
        LaneAverages windows[2];
        kernel(samples.data(), centres, windows);
        int counted[2];
        for (int m = 0; m < 2; ++m) {
            Symmetric3 sum;
            SlopeFit slopes;
            double weights = 0, normals[2] = {};
            for (const std::int32_t s : row) {
                if (s < 0) continue;
                const SurfaceSample& sample = samples[static_cast<std::size_t>(s)];
                const Vec3 its = load(sample.normal), d = load(sample.foot) - at;
                const double along = dot(its, normal), weight = sample.weight * (1 - squared(d) / centres.reach[m][0]);
                if (!(std::abs(along) >= one_sheet) || !(weight > 0)) continue;
                const double side = along < 0 ? -1 : 1;
                add(sum, side * weight, carried(tensor_of(sample), side * its, normal));
                slopes.add(dot(d, frame.u) / whole, dot(d, frame.v) / whole, dot(side * its, frame.u),
                           dot(side * its, frame.v), weight);
                weights += weight;
                normals[0] += weight * side * dot(its, frame.u), normals[1] += weight * side * dot(its, frame.v);
            }
            slopes.let_free(0.4, weights, normals);
            counted[m] = slopes.count();
            for (const int lane : {0, 2, 3}) {
                const LaneAverages& found = windows[m];
                EXPECT_NEAR(found.weight[lane], weights, 1e-12 * weights);
                EXPECT_NEAR(found.tensor[0][lane], dot(frame.u, product(sum, frame.u)), 1e-12 * weights);
                EXPECT_NEAR(found.tensor[1][lane], dot(frame.u, product(sum, frame.v)), 1e-12 * weights);
                EXPECT_NEAR(found.tensor[2][lane], dot(frame.v, product(sum, frame.v)), 1e-12 * weights);
                Slopes truth, fit;
                ASSERT_TRUE(slopes.solve<5>(truth) && found.slopes(lane, 0.4).solve<5>(fit));
                EXPECT_EQ(fit.free, truth.free);
                EXPECT_NEAR(fit.residual, truth.residual, 1e-10);
                for (int a = 0; a < 2; ++a) {
                    EXPECT_NEAR(fit.shift[a], truth.shift[a], 1e-9);
                    for (int b = 0; b < 2; ++b) {
                        EXPECT_NEAR(fit.s[a][b], truth.s[a][b], 1e-10);
                        EXPECT_NEAR(fit.covariance[a][b], truth.covariance[a][b], 1e-9);
                    }
                }
            }
            EXPECT_EQ(windows[m].weight[1], 0);
            EXPECT_EQ(windows[m].count[1], 0);
        }
        EXPECT_GE(counted[0], 10);
        EXPECT_GT(counted[1], counted[0]);
        EXPECT_LT(counted[1], count - 5);
    }
}

TEST(LaneAverages, StandAloneWithTheSameBitsFromEveryInstructionSet) {
    Random random(2);
    const std::vector<SurfaceSample> samples = samples_about_the_pole(random);
    const std::vector<std::int32_t> row = rows(), nothing(count, -1);
    const Vec3 at = {0.02, 0.03, 1};
    LaneCentres alike, mixed;
    for (int l = 0; l < fit_lanes; ++l) {
        centre(alike, l, row, {0, 0, 1}, at);
        centre(mixed, l, l == 1 ? nothing : row, l == 2 ? Vec3{NAN, NAN, NAN} : Vec3{0, 0, 1}, at);
    }
    LaneAverages first[2];
    lane_averages_baseline(samples.data(), alike, first);
    for (LaneAverageKernel* kernel : kernels()) {
        LaneAverages again[2], among[2];
        kernel(samples.data(), alike, again);
        kernel(samples.data(), mixed, among);
        EXPECT_EQ(std::memcmp(first, again, sizeof first), 0);
        for (int m = 0; m < 2; ++m)
            for (const int l : {0, 3}) {
                EXPECT_EQ(among[m].tensor[1][l], first[m].tensor[1][l]);
                for (int p = 0; p < SlopeFit::powers; ++p) EXPECT_EQ(among[m].power[p][l], first[m].power[p][l]);
                EXPECT_EQ(among[m].square[l], first[m].square[l]);
            }
        for (int m = 0; m < 2; ++m)
            for (const int l : {1, 2}) EXPECT_EQ(among[m].count[l], 0);
    }
}
