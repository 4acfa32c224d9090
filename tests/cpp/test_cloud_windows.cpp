// Fits over the wide windows of the ladder: against sums made one by one, on a sphere about points that noise has
// lifted off it, and the same bits whatever goes along and from every instruction set.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "../../src/shape_tensor.h"
#include "../../src/window_fits.h"
#include "lane_fit_kernels.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

constexpr double radius = 2;
constexpr int count = 150;
constexpr Vec3 unknown = {NAN, NAN, NAN};

/// Points on a cap of a sphere about the origin, whose pole is along z, nearest to the pole first.
std::vector<Vec3> cap(std::uint64_t seed, double noise) {
    Random random(seed);
    std::vector<Vec3> points;
    for (int j = 0; j < count; ++j) {
        const double polar = 0.6 * std::sqrt((j + 1.0) / count), angle = 6.3 * random.uniform();
        const double r = radius + noise * (random.uniform() - 0.5);
        points.push_back(r *
                         Vec3{std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar)});
    }
    return points;
}

void fill(WindowFits& windows, const std::vector<Vec3>& points, Vec3 element) {
    for (const Vec3 point : points) windows.add(point - element);
    windows.close();
}

}  // namespace

/// Quadric and quartic against the sums of all products of monomials, one neighbour after the other.
TEST(WindowFits, AreThoseOfPlainSums) {
    const std::vector<Vec3> points = cap(1, 0.05);
    WindowFits windows(count);
    fill(windows, points, {0, 0, radius});
    windows.fit({unknown}, true);
    const WindowFit& fit = windows[0];
    ASSERT_TRUE(fit.determined[0] && fit.determined[1]);

    Moments<4> moments;
    moments.clear();
    for (const Vec3 point : points) {
        const Vec3 d = 1 / fit.view.size * (point - Vec3{0, 0, radius} - fit.view.foot);
        const double u = dot(d, fit.frame.u), v = dot(d, fit.frame.v), stretch = length(d) / std::hypot(u, v);
        moments.add(stretch * u, stretch * v, dot(d, fit.frame.n), 1 - std::min(squared(d), 1.0) / 1.1);
    }
    const auto expect = [&](const auto& field, int q) {
        for (std::size_t m = 0; m < 6; ++m) EXPECT_NEAR(fit.field[q].c[m], field.c[m], 1e-12) << q << m;
        EXPECT_NEAR(fit.field[q].residual, field.residual, 1e-12 * field.residual);
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
                EXPECT_NEAR(fit.field[q].covariance[a][b], field.covariance[a][b], 1e-12 * field.covariance[0][0]);
        EXPECT_EQ(field.free, count - WindowFit::unknowns[q]);
    };
    HeightField<2> quadric;
    HeightField<4> quartic;
    ASSERT_TRUE(moments.solve(true, quadric, true) && moments.solve(true, quartic, true));
    expect(quadric, 0);
    expect(quartic, 1);
    EXPECT_NEAR(fit.weight, moments.weight(), 1e-12 * fit.weight);
}

/// The view goes to the sphere under an element above it, from a normal that is off or from none.
TEST(WindowFits, FindTheFootOfALiftedElement) {
    const std::vector<Vec3> points = cap(2, 0);
    const Vec3 element = {0.1, 0, radius + 0.08}, tilted = unit(Vec3{0.2, 0.1, 1});
    WindowFits windows(count);
    for (int l = 0; l < 3; ++l) fill(windows, points, element);
    windows.fit({tilted, unknown, tilted}, true);
    for (int l = 0; l < 3; ++l) {
        ASSERT_TRUE(windows[l].determined[0] && windows[l].determined[1]);
        for (int q = 0; q < 2; ++q) {
            const HeightField<2>& field = windows[l].field[q];
            const Vec3 foot = element + windows[l].view.foot + windows[l].view.size * field.c[0] * windows[l].frame.n;
            EXPECT_NEAR(length(foot), radius, 1e-4);
            const SurfaceJet jet = surface_jet(field.c, windows[l].frame, windows[l].view.size);
            EXPECT_NEAR(std::abs(dot(jet.normal, unit(foot))), 1, 1e-6);
            EXPECT_NEAR(squared_norm(jet.tensor), 2 / (radius * radius), 1e-3);
        }
    }
}

/// A lane does not depend on what the others hold, nor on what the windows held before.
TEST(WindowFits, StandAlone) {
    const std::vector<Vec3> points = cap(3, 0.05);
    std::vector<Vec3> other = cap(4, 0.2);
    other.resize(40);
    WindowFits alone(count), among(count);
    fill(alone, points, {0, 0, radius});
    alone.fit({unknown}, true);
    for (int l = 0; l < 4; ++l) fill(among, other, {0, 0, radius});
    among.fit({unknown, unknown, unknown, unknown}, true);
    among.clear();
    among.add({1, 2, 3});
    among.drop();
    fill(among, other, {0, 0, radius});
    fill(among, points, {0, 0, radius});
    among.fit({{0, 0, 1}, unknown}, true);
    for (int q = 0; q < 2; ++q) {
        ASSERT_TRUE(alone[0].determined[q]);
        EXPECT_EQ(alone[0].field[q].c, among[1].field[q].c);
        EXPECT_EQ(alone[0].field[q].residual, among[1].field[q].residual);
    }
}

/// Nothing is determined on a line, nor where all neighbours are the element itself, nor without any view.
TEST(WindowFits, TellWhatIsNotDetermined) {
    WindowFits windows(count);
    for (int j = 0; j < 30; ++j) windows.add({0.1 * j, 0, 0});
    windows.close();
    for (int j = 0; j < 30; ++j) windows.add({0, 0, 0});
    windows.close();
    fill(windows, cap(5, 0), {0, 0, radius});
    windows.fit({{0, 0, 1}, {0, 0, 1}, unknown}, false);
    for (int l = 0; l < 3; ++l) EXPECT_FALSE(windows[l].determined[0] || windows[l].determined[1]) << l;
}

TEST(WindowFits, SameBitsFromEveryInstructionSet) {
    const std::vector<Vec3> points = cap(6, 0.05);
    std::vector<LaneFields> found;
    for (const LaneFitKernel* kernel : lane_fit_kernels()) {
        WindowFits windows(count);
        for (std::size_t l = 0; l < 4; ++l)
            fill(windows, {points.begin(), points.end() - static_cast<std::ptrdiff_t>(7 * l)}, {0, 0, radius});
        windows.fit({{0, 0, 1}, unknown, {0, 0, 1}, unknown}, true, *kernel);
        LaneFields fields = {};
        for (int l = 0; l < 4; ++l) {
            ASSERT_TRUE(windows[l].determined[1]);
            for (std::size_t m = 0; m < 6; ++m) fields.c[m][l] = windows[l].field[1].c[m];
            fields.residual[l] = windows[l].field[1].residual;
        }
        found.push_back(fields);
    }
    for (const LaneFields& fields : found) EXPECT_EQ(std::memcmp(&fields, &found[0], sizeof fields), 0);
}
