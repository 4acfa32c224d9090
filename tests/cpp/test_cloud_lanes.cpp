// Fits of four elements side by side: against polynomials that they must find, lane by lane, and the same bits from
// every instruction set.
#include <cmath>
#include <cstring>
#include <vector>

#include "../../src/lane_fits.h"
#include "lane_fit_kernels.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

constexpr Weights all_weights[] = {Weights::equal, Weights::remainder, Weights::smoothing};
constexpr Frame plain = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// A polynomial of the fourth degree, another in each lane.
double height(int lane, double u, double v) {
    const double a = 1 + 0.25 * lane;
    return 0.03 * a * u - 0.02 * v + 0.3 * u * u - 0.1 * a * u * v + 0.2 * v * v + 0.05 * a * u * u * u -
           0.04 * u * v * v + 0.03 * u * u * v * v - 0.02 * a * v * v * v * v;
}

LanePatches random_patches(std::uint64_t seed) {
    Random random(seed);
    LanePatches patches;
    for (int j = 0; j < most_fitted; ++j)
        for (int l = 0; l < fit_lanes; ++l) {
            const double reach = std::sqrt((j + 1) / 9.0), angle = 6.3 * random.uniform();
            const double u = reach * std::cos(angle), v = reach * std::sin(angle);
            patches.d[j][0][l] = u, patches.d[j][1][l] = v, patches.d[j][2][l] = height(l, u, v);
        }
    for (int l = 0; l < fit_lanes; ++l) patches.see(l, plain, 1);
    return patches;
}

LaneRange range(int count, Chart chart, Weights weights) {
    return {{}, {count, count, count, count}, chart, weights};
}

LaneFields fit(const LaneFit& kernel, const LanePatches& patches, const LaneRange& range, AtElement element) {
    LaneSums sums;
    LaneFields fields = {};
    kernel.collect(patches.d, patches, range, true, sums);
    kernel.solve(sums, element, true, fields);
    return fields;
}

}  // namespace

TEST(LaneFits, FindPolynomials) {
    const LanePatches patches = random_patches(1);
    for (const LaneFitKernel* kernel : lane_fit_kernels())
        for (const Weights weights : all_weights)
            for (const AtElement element : {AtElement::zero, AtElement::datum, AtElement::free}) {
                const LaneFields fields = fit(kernel->quartic, patches, range(24, Chart::monge, weights), element);
                for (int l = 0; l < fit_lanes; ++l) {
                    const double a = 1 + 0.25 * l, truth[6] = {0, 0.03 * a, -0.02, 0.3, -0.1 * a, 0.2};
                    ASSERT_TRUE(fields.determined[l]);
                    for (int m = 0; m < 6; ++m) ASSERT_NEAR(fields.c[m][l], truth[m], 1e-9) << l << ' ' << m;
                    ASSERT_NEAR(fields.residual[l], 0, 1e-9);
                }
            }
}

TEST(LaneFits, ChordsMakeSpheresQuadrics) {
    Random random(2);
    LanePatches patches;
    const double radius = 1.7;
    for (int j = 0; j < 9; ++j)
        for (int l = 0; l < fit_lanes; ++l) {
            const double polar = 0.6 * random.uniform(), angle = 6.3 * random.uniform();
            patches.d[j][0][l] = radius * std::sin(polar) * std::cos(angle);
            patches.d[j][1][l] = radius * std::sin(polar) * std::sin(angle);
            patches.d[j][2][l] = radius * (std::cos(polar) - 1);
        }
    for (int l = 0; l < fit_lanes; ++l) patches.see(l, plain, 1);
    for (const LaneFitKernel* kernel : lane_fit_kernels()) {
        const LaneFields fields =
            fit(kernel->quadric, patches, range(9, Chart::chord, Weights::equal), AtElement::zero);
        for (int l = 0; l < fit_lanes; ++l) {
            ASSERT_NEAR(fields.c[3][l], -0.5 / radius, 1e-12);
            ASSERT_NEAR(fields.c[4][l], 0, 1e-12);
            ASSERT_NEAR(fields.c[5][l], -0.5 / radius, 1e-12);
        }
    }
}

/// The covariance is that of the coefficients under noise: the fit is linear in the heights, so unit heights one after
/// the other tell it.
TEST(LaneFits, CovarianceOfUnitNoise) {
    const LanePatches patches = random_patches(3);
    const LaneRange over = range(24, Chart::monge, Weights::equal);
    for (const LaneFitKernel* kernel : lane_fit_kernels()) {
        const LaneFields fields = fit(kernel->quartic, patches, over, AtElement::zero);
        double sum[3][3] = {};
        for (int j = 0; j < 24; ++j) {
            LanePatches unit = patches;
            for (int i = 0; i < 24; ++i) unit.d[i][2][1] = i == j ? 1 : 0;
            const LaneFields one = fit(kernel->quartic, unit, over, AtElement::zero);
            const double q[3] = {2 * one.c[3][1], one.c[4][1], 2 * one.c[5][1]};
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) sum[a][b] += q[a] * q[b];
        }
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
                ASSERT_NEAR(fields.covariance[a][b][1], sum[a][b], 1e-7 * std::abs(sum[0][0])) << a << b;
    }
}

TEST(LaneFits, RangesAddUp) {
    const LanePatches patches = random_patches(4);
    for (const LaneFitKernel* kernel : lane_fit_kernels()) {
        LaneSums sums;
        LaneFields fields = {};
        LaneRange part = {{}, {24, 20, 16, 24}, Chart::chord, Weights::equal};
        kernel->quartic.collect(patches.d, patches, part, true, sums);
        std::copy(part.last, part.last + fit_lanes, part.first);
        std::fill_n(part.last, fit_lanes, 36);
        kernel->quartic.collect(patches.d, patches, part, false, sums);
        kernel->quartic.solve(sums, AtElement::datum, false, fields);
        const LaneFields whole =
            fit(kernel->quartic, patches, range(36, Chart::chord, Weights::equal), AtElement::datum);
        for (int l = 0; l < fit_lanes; ++l)
            for (int m = 0; m < 6; ++m) ASSERT_NEAR(fields.c[m][l], whole.c[m][l], 1e-10);
    }
}

/// Of points on four lines, one through the element, a quartic is not determined, whatever the other lanes hold, and no
/// lane is moved by another.
TEST(LaneFits, LanesStandAlone) {
    const LanePatches good = random_patches(5);
    LanePatches mixed = good;
    for (int j = 0; j < 24; ++j) mixed.d[j][0][1] = j % 4 - 1, mixed.d[j][1][1] = j / 4 - 2.5, mixed.d[j][2][1] = 0.1;
    mixed.see(2, {{NAN, NAN, NAN}, {NAN, NAN, NAN}, {NAN, NAN, NAN}}, NAN);
    for (const LaneFitKernel* kernel : lane_fit_kernels())
        for (const Weights weights : all_weights) {
            const LaneFields all = fit(kernel->quartic, good, range(24, Chart::chord, weights), AtElement::zero),
                             some = fit(kernel->quartic, mixed, range(24, Chart::monge, weights), AtElement::zero),
                             chord = fit(kernel->quartic, mixed, range(24, Chart::chord, weights), AtElement::zero);
            EXPECT_FALSE(some.determined[1]);
            EXPECT_FALSE(some.determined[2]);
            EXPECT_TRUE(some.determined[0] && some.determined[3]);
            for (const int l : {0, 3})
                for (int m = 0; m < 6; ++m) ASSERT_EQ(all.c[m][l], chord.c[m][l]);
        }
}

#ifdef __x86_64__
TEST(LaneFits, SameBitsFromEveryInstructionSet) {
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this machine has no AVX2";
    const LanePatches patches = random_patches(6);
    for (const Chart chart : {Chart::monge, Chart::chord})
        for (const Weights weights : all_weights)
            for (const AtElement element : {AtElement::zero, AtElement::datum, AtElement::free}) {
                LaneRange over = range(24, chart, weights);
                over.last[1] = 17, over.first[2] = 3, over.last[3] = 23;
                const LaneFields one = fit(lane_fit_baseline.quartic, patches, over, element),
                                 other = fit(lane_fit_avx2.quartic, patches, over, element);
                ASSERT_EQ(std::memcmp(&one, &other, sizeof one), 0);
                const LaneFields few = fit(lane_fit_baseline.quadric, patches, range(9, chart, weights), element),
                                 same = fit(lane_fit_avx2.quadric, patches, range(9, chart, weights), element);
                ASSERT_EQ(std::memcmp(&few, &same, sizeof few), 0);
            }
}
#endif
