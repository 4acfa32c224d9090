// The errors told of spheres, in the middle of a square of elements, where nothing of its border is felt.
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "../../src/scale_ladder.h"
#include "../../src/sphere_errors.h"
#include "support.h"

using namespace gaussmap;

namespace {

constexpr int side = 40;
constexpr std::size_t count = side * side, middle = (side + 1) * side / 2;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// Elements a length of 1 apart, each with the eight about it.
Level square() {
    Level level;
    level.graph.index.assign(count * ElementGraph::degree, -1);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            level.foot.insert(level.foot.end(), {double(x), double(y), 0});
            std::size_t at = static_cast<std::size_t>(y * side + x) * ElementGraph::degree;
            for (int d = 0; d < 9; ++d) {
                const int u = x + d % 3 - 1, v = y + d / 3 - 1;
                if (d != 4 && u >= 0 && u < side && v >= 0 && v < side) level.graph.index[at++] = v * side + u;
            }
        }
    level.position = level.foot;
    return level;
}

struct Told {
    Family family = Family::sphere;
    double slope = 0;  ///< of the density, 2 in the middle, along x
    float error = 0.01F, noise = 0.004F, disagreement = 0, cut = 1;
};

/// The squared error of the middle element.
double told(const Told& before, float variance_of_heights) {
    const Level level = square();
    Measured measured = nothing_measured(count);
    for (std::size_t i = 0; i < count; ++i) measured.density[i] = 2 + before.slope * (level.foot[3 * i] - side / 2);
    measured.choice.assign(count, rung_choice(9, before.family));
    measured.error.assign(count, before.error), measured.noise.assign(count, before.noise);
    measured.disagreement.assign(count, before.disagreement), measured.cut.assign(count, before.cut);
    tell_sphere_errors(level, std::vector<float>(count, variance_of_heights), measured, {1, {}});
    return measured.error[middle];
}

}  // namespace

TEST(SphereErrors, NoiseMovesPointsAlongTheSurface) {
    for (const Family family : {Family::sphere, Family::fine_sphere, Family::extrapolated}) {
        EXPECT_NEAR(told({.family = family, .slope = 0.1}, 0.5F), 0.4 * 0.004 + 0.5 * 0.1 * 0.1, 1e-7);
        EXPECT_NEAR(told({.family = family, .slope = 0.1}, unknown), 0.4 * 0.004, 1e-7) << "as far as it is known";
    }
}

TEST(SphereErrors, BiasGoesWithTheWindowAndTheDisagreement) {
    // Windows of 648; 0.006 were told beside the noise.
    const double expected = 0.045 * std::pow(648, 0.75) * 0.006 * std::sqrt(0.09 / (2 * 2 + 0.09));
    EXPECT_NEAR(told({.disagreement = 0.09F}, 0) - 0.4 * 0.004, expected, 1e-6);
    EXPECT_NEAR(told({.error = 0.004F + 0.012F, .disagreement = 0.09F}, 0) - 0.4 * 0.004, 2 * expected, 1e-6);
    EXPECT_NEAR(told({.disagreement = 0}, 0), 0.4 * 0.004, 1e-8);
    const Told extrapolated = {.family = Family::extrapolated, .disagreement = 0.09F};
    EXPECT_NEAR(told(extrapolated, 0) - 0.4 * 0.004, 0.3 / 0.045 * expected, 1e-6);
    EXPECT_NEAR(told({.family = Family::fine_sphere, .disagreement = 0.09F}, 0) - 0.4 * 0.004, expected, 1e-6);
}

TEST(SphereErrors, BiasIsMoreBesideBorders) {
    const auto bias = [](float cut) { return told({.noise = 0, .disagreement = 0.09F, .cut = cut}, 0); };
    EXPECT_NEAR(bias(2), std::sqrt(2) * bias(1), 1e-6);
    EXPECT_NEAR(bias(4), 2 * bias(1), 1e-6);
    EXPECT_EQ(bias(9), bias(4));
    EXPECT_EQ(bias(unknown), bias(1));
}

TEST(SphereErrors, OthersTellTheirOwn) {
    for (const Family family :
         {Family::quadric, Family::half_mean, Family::mean, Family::half_slope, Family::slope, Family::quartic})
        EXPECT_EQ(told({.family = family, .slope = 0.1, .disagreement = 0.09F, .cut = 3}, 0.5F), 0.01F);
}
