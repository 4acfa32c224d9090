// What twicing adds to the errors of a ladder's densities, on a flat torus of elements with eight neighbours each.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "../../src/scale_ladder.h"
#include "../../src/window_bias.h"
#include "support.h"

using namespace gaussmap;

namespace {

constexpr int side = 48;
constexpr std::size_t count = side * side;

ElementGraph grid() {
    ElementGraph graph;
    graph.index.assign(count * ElementGraph::degree, -1);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            std::size_t at = static_cast<std::size_t>(y * side + x) * ElementGraph::degree;
            for (int d = 0; d < 9; ++d)
                if (d != 4) graph.index[at++] = (y + d / 3 - 1 + side) % side * side + (x + d % 3 - 1 + side) % side;
        }
    return graph;
}

/// Densities 2 + waves with a crest every `length` elements, all of one choice.
Measured waves(double length, Family family, float error, float noise) {
    Measured measured = nothing_measured(count);
    for (std::size_t i = 0; i < count; ++i) {
        measured.density[i] = 2 + std::sin(2 * std::numbers::pi / length * static_cast<double>(i % side));
        measured.choice[i] = rung_choice(9, family);
    }
    measured.error.assign(count, error), measured.noise.assign(count, noise);
    return measured;
}

std::vector<float> added(double length, Family family, float error, float noise) {
    static const ElementGraph graph = grid();
    Measured measured = waves(length, family, error, noise);
    add_window_bias(graph, measured, {1, {}});
    for (float& e : measured.error) e -= error;
    return measured.error;
}

}  // namespace

TEST(WindowBias, IsWhatAWindowTakesAwayOfAWave) {
    // An average over the eight and the element leaves (1 + 2 cos q) / 3 of a wave; the window of 648 takes ten of
    // them.
    for (const double length : {48.0, 24.0, 16.0}) {
        const std::vector<float> found = added(length, Family::mean, 0.001F, 0);
        const double left = std::pow((1 + 2 * std::cos(2 * std::numbers::pi / length)) / 3, 10);
        const double expected = 0.5 * 5 * std::pow(648 / (60.0 * 10) * (1 - left), 2);
        double mean = 0;
        for (const float more : found) mean += static_cast<double>(more) / count;
        EXPECT_NEAR(mean, expected, 0.001 * expected) << length;
    }
}

TEST(WindowBias, IsNothingWhereTheDensityIsOneValue) {
    for (const Family family : {Family::mean, Family::quartic}) {
        for (const float more : added(1, family, 0.001F, 0.0005F)) EXPECT_NEAR(more, 0, 1e-9);
    }
}

TEST(WindowBias, OfQuarticsIsWhatTheirWindowTakesAwayTwice) {
    // Five averages; what both of them leave of a wave is the square of what one of them takes.
    for (const double length : {24.0, 16.0}) {
        const std::vector<float> found = added(length, Family::quartic, 0.001F, 0);
        const double left = std::pow((1 + 2 * std::cos(2 * std::numbers::pi / length)) / 3, 5);
        const double expected = 0.5 * 5.4 * std::pow(648 / (120.0 * 5), 4) * std::pow(1 - left, 4);
        double mean = 0;
        for (const float more : found) mean += static_cast<double>(more) / count;
        EXPECT_NEAR(mean, expected, 0.001 * expected) << length;
    }
}

TEST(WindowBias, DoesNotCountWhatNoiseShows) {
    const std::vector<float> without = added(24, Family::mean, 0.5F, 0), with = added(24, Family::mean, 0.5F, 0.001F),
                             all = added(24, Family::mean, 0.5F, 0.4F);
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_NEAR(with[i], without[i] - 0.004F, 1e-6F) << i;
        EXPECT_EQ(all[i], 0) << i;
    }
}

TEST(WindowBias, LeavesAloneWhoNeverClimbedAndSpheres) {
    static const ElementGraph graph = grid();
    Measured measured = waves(24, Family::mean, 0.01F, 0);
    for (std::size_t i = 0; i < count; i += 2) measured.choice[i] = 2;
    add_window_bias(graph, measured, {1, {}});
    for (std::size_t i = 0; i < count; i += 2) EXPECT_EQ(measured.error[i], 0.01F) << i;
    for (const Family family : {Family::sphere, Family::fine_sphere, Family::extrapolated})
        for (const float more : added(24, family, 0.01F, 0)) EXPECT_EQ(more, 0);
}
