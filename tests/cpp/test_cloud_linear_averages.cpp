// What is left of densities by linear averages, on a square of elements with the eight about each.
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "../../src/linear_averages.h"
#include "../../src/scale_ladder.h"
#include "support.h"

using namespace gaussmap;

namespace {

constexpr int side = 40;
constexpr std::size_t count = side * side, middle = (side + 1) * side / 2;

/// Elements a length of 1 apart, moved by up to `uneven` each, on a plane that is tilted.
struct Square {
    Level level;
    Measured measured = nothing_measured(count);
    std::vector<double> x, y;

    explicit Square(double uneven = 0) {
        const Vec3 u = {0.8, 0, 0.6}, v = {0, 1, 0}, n = {-0.6, 0, 0.8};
        std::mt19937 random(7);
        std::uniform_real_distribution<double> moved(-uneven, uneven);
        level.graph.index.assign(count * ElementGraph::degree, -1);
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column) {
                x.push_back(column + moved(random)), y.push_back(row + moved(random));
                const Vec3 at = x.back() * u + y.back() * v + moved(random) * n;
                level.position.insert(level.position.end(), {at.x, at.y, at.z});
                std::size_t to = x.size() * ElementGraph::degree - ElementGraph::degree;
                for (int d = 0; d < 9; ++d) {
                    const int c = column + d % 3 - 1, r = row + d / 3 - 1;
                    if (d != 4 && c >= 0 && c < side && r >= 0 && r < side) level.graph.index[to++] = r * side + c;
                }
            }
        measured.normal.assign(count, n);
        measured.choice.assign(count, rung_choice(9, Family::sphere));
        measured.density.assign(count, 1);
        measured.tensor.assign(count, Symmetric3{});
        measured.error.assign(count, 0.5F), measured.noise.assign(count, 0.1F);
    }

    void smooth(float noise = 0) { smooth_densities(level, std::vector<float>(count, noise), measured, {1, {}}); }
};

}  // namespace

TEST(LinearAverages, KeepWhatIsLinear) {
    // Beside the border, too, and wherever the elements lie over the plane.
    Square square(0.4);
    for (std::size_t i = 0; i < count; ++i) square.measured.density[i] = 100 + 2 * square.x[i] - square.y[i];
    square.smooth();
    for (std::size_t i = 0; i < count; ++i)
        EXPECT_NEAR(square.measured.density[i], 100 + 2 * square.x[i] - square.y[i], 0.02) << i;
}

TEST(LinearAverages, LeaveOfAWaveWhatTwicingLeaves) {
    // On a grid the linear fit is the average over the nine, which leaves a of a wave. Noise is relative to the
    // variance of the eight along an axis, 3/4.
    struct Case {
        float noise, part;
    };
    for (const Case& c : {Case{std::numeric_limits<float>::quiet_NaN(), 0}, Case{0, 0}, Case{0.3F, 0.4F}, Case{3, 1}})
        for (const double length : {24.0, 12.0, 4.0}) {
            Square square;
            const double turn = 2 * std::numbers::pi / length;
            for (std::size_t i = 0; i < count; ++i)
                square.measured.density[i] = 2 + std::cos(turn * (square.x[i] - side / 2));
            square.smooth(c.noise);
            const double a = (1 + 2 * std::cos(turn)) / 3, still = 1 - std::pow(1 - a * a, 3),
                         moved = 1 - std::pow(1 - a * a * a, 2), part = static_cast<double>(c.part);
            EXPECT_NEAR(square.measured.density[middle], 2 + (1 - part) * still + part * moved, 1e-5) << length;
        }
}

TEST(LinearAverages, TakeAwayNoise) {
    Square square(0.3);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.1);
    for (double& d : square.measured.density) d = 5 + noise(random);
    square.smooth();
    double sum = 0;
    for (const double d : square.measured.density) sum += (d - 5) * (d - 5) / count;
    EXPECT_LT(std::sqrt(sum), 0.045);
    EXPECT_GT(std::sqrt(sum), 0.02) << "of neighbours no further than six";
}

TEST(LinearAverages, TensorsGoWithTheDensities) {
    Square square(0.3);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0.1, 3);
    for (std::size_t i = 0; i < count; ++i) {
        square.measured.tensor[i].xx = any(random), square.measured.tensor[i].yz = any(random);
        square.measured.density[i] = squared_norm(square.measured.tensor[i]);
    }
    const Measured before = square.measured;
    square.smooth();
    for (std::size_t i = 0; i < count; ++i) {
        const Symmetric3 &was = before.tensor[i], &is = square.measured.tensor[i];
        EXPECT_GE(square.measured.density[i], 0);
        EXPECT_NEAR(squared_norm(is), square.measured.density[i], 1e-9 * before.density[i]) << i;
        EXPECT_NEAR(is.xx * was.yz, is.yz * was.xx, 1e-9) << i;
    }
}

TEST(LinearAverages, NeitherOtherSheetsNorUndefinedNeighboursCount) {
    // Every second column is of a sheet at right angles; one element of each sheet has no density.
    Square square;
    for (std::size_t i = 0; i < count; ++i)
        if (i % 2 == 1) square.measured.normal[i] = {0, 1, 0}, square.measured.density[i] = 50;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    square.measured.density[middle] = square.measured.density[middle + 1] = nan;
    square.smooth();
    for (std::size_t i = 0; i < count; ++i) {
        if (i == middle || i == middle + 1)
            EXPECT_TRUE(std::isnan(square.measured.density[i]));
        else
            EXPECT_NEAR(square.measured.density[i], i % 2 == 1 ? 50 : 1, 1e-4) << i;
    }
}

TEST(LinearAverages, DoNotOvershootBesideAnEdge) {
    Square square;
    for (std::size_t i = 0; i < count; ++i) square.measured.density[i] = i % side < side / 2 ? 0.01 : 100;
    square.smooth();
    for (std::size_t i = 0; i < count; ++i) {
        const double before = i % side < side / 2 ? 0.01 : 100;
        EXPECT_GE(square.measured.density[i], before / 2) << i;
        EXPECT_LE(square.measured.density[i], before * 2) << i;
    }
}

TEST(LinearAverages, WhoNeverClimbedCountsAndStays) {
    Square square;
    square.measured.density[middle] = 10, square.measured.choice[middle] = 2;
    square.smooth();
    EXPECT_EQ(square.measured.density[middle], 10);
    EXPECT_EQ(square.measured.error[middle], 0.5F);
    EXPECT_NEAR(square.measured.error[middle + 1], 0.5 - 0.15 * 0.1, 1e-6) << "what noise goes";
    EXPECT_NEAR(square.measured.noise[middle + 1], 0.085, 1e-6);
    EXPECT_GT(square.measured.density[middle + 1], 1.5);
}
