// What is mixed, lent and handed down between elements and levels of the ladder: against sums over all estimates, and
// on a sphere whose coarse level knows better.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "../../src/frame.h"
#include "../../src/pyramid.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

constexpr float never = std::numeric_limits<float>::infinity();

Symmetric3 across(Vec3 normal, double k) {
    const Frame frame = frame_about(normal);
    Symmetric3 tensor;
    add_product(tensor, k, frame.u, frame.u);
    add_product(tensor, k, frame.v, frame.v);
    return tensor;
}

/// A unit sphere's points along a spiral, each its own foot, with ten neighbours.
Level sphere_level(std::size_t count) {
    Level level;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(count), r = std::sqrt(1 - z * z),
                     turn = std::numbers::pi * (3 - std::sqrt(5.0)) * static_cast<double>(i);
        const Vec3 p = {r * std::cos(turn), r * std::sin(turn), z};
        level.position.insert(level.position.end(), {p.x, p.y, p.z});
        level.normal.push_back(p);
    }
    level.foot = level.position;
    level.area.assign(count, 1);
    level.graph.index.assign(count * ElementGraph::degree, -1);
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<std::pair<double, std::int32_t>> others;
        for (std::size_t j = 0; j < count; ++j)
            if (j != i) others.emplace_back(squared(level.at(j) - level.at(i)), static_cast<std::int32_t>(j));
        std::sort(others.begin(), others.end());
        for (std::size_t j = 0; j < ElementGraph::degree; ++j)
            level.graph.index[i * ElementGraph::degree + j] = others[j].second;
    }
    return level;
}

/// A density that varies over the sphere.
double density_at(Vec3 p) {
    return 3 + p.x + 0.5 * p.y * p.z;
}

}  // namespace

TEST(Pyramid, MixesByWeightAndTellsOfTheBest) {
    Random random(1);
    Measured measured = nothing_measured(1);
    const Vec3 pole = {0, 0, 1};
    double sum = 0, weights = 0, curvature = 0;
    float best = never;
    for (int e = 0; e < 9; ++e) {
        const double k = 1 + 0.1 * random.normal(), weight = e == 4 ? 0 : random.uniform();
        const float risk = e == 4 ? 0 : static_cast<float>(0.1 + random.uniform());
        // Either side of the surface.
        const double side = e % 2 == 0 ? 1 : -1;
        mix({2 * k * k, risk, 2 * risk, 0.5F * risk, side * pole, across(pole, side * k), static_cast<std::uint8_t>(e)},
            weight, 0, measured);
        sum += weight * 2 * k * k, weights += weight, curvature += weight * k;
        if (weight > 0) best = std::min(best, risk);
        EXPECT_NEAR(measured.density[0], sum / weights, 1e-12);
        EXPECT_EQ(measured.risk[0], best) << "an estimate without weight is none";
        EXPECT_EQ(measured.error[0], 2 * best);
        EXPECT_EQ(measured.noise[0], 0.5F * best);
        EXPECT_NEAR(measured.tensor[0].xx * measured.normal[0].z, curvature / weights, 1e-12);
    }
    EXPECT_NEAR(measured.weight[0], weights, 1e-12);
}

TEST(Pyramid, AreasCountTheElementsThatAreNearest) {
    Level lowest = sphere_level(600);
    Level middle = coarsened(lowest, {1, {}});
    const Level top = coarsened(middle, {1, {}});
    const auto nearest = [](const Level& level, Vec3 p) {
        std::size_t best = 0;
        for (std::size_t g = 1; g < level.count(); ++g)
            if (squared(level.foot_of(g) - p) < squared(level.foot_of(best) - p)) best = g;
        return best;
    };
    std::vector<float> of_middle(middle.count(), 0), of_top(top.count(), 0);
    for (std::size_t i = 0; i < lowest.count(); ++i) {
        const std::size_t g = nearest(middle, lowest.foot_of(i));
        of_middle[g] += 1;
        of_top[nearest(top, middle.foot_of(g))] += 1;
    }
    EXPECT_EQ(middle.area, of_middle);
    EXPECT_EQ(top.area, of_top);
    EXPECT_GT(*std::max_element(top.area.begin(), top.area.end()),
              1.5F * *std::min_element(top.area.begin(), top.area.end()));
}

TEST(Pyramid, WhatCoarserLevelsFoundIsMixedIn) {
    Level fine = sphere_level(600);
    const Level coarse = coarsened(fine, {1, {}});
    ASSERT_EQ(coarse.count(), 200U);
    Measured above = nothing_measured(coarse.count()), below = nothing_measured(fine.count());
    for (std::size_t g = 0; g < coarse.count(); ++g)
        mix({density_at(coarse.foot_of(g)), 0.01F, 0.02F, 0.005F, coarse.normal[g], across(coarse.normal[g], 1), 20}, 3,
            g, above);
    for (std::size_t i = 0; i < fine.count(); ++i)
        mix({density_at(fine.foot_of(i)) + 0.4, 0.1F, 0.2F, 0.05F, fine.normal[i], across(fine.normal[i], 1), 17}, 1, i,
            below);
    refine(coarse, above, fine, below, {1, {}});
    for (std::size_t i = 0; i < fine.count(); ++i) {
        // A quarter of the fine level's error is left, and what interpolation between coarse ones errs.
        EXPECT_NEAR(below.density[i], density_at(fine.foot_of(i)) + 0.1, 0.02) << i;
        EXPECT_EQ(below.choice[i], 20);
        EXPECT_EQ(below.error[i], 0.02F);
        EXPECT_EQ(below.noise[i], 0.005F);
        EXPECT_DOUBLE_EQ(below.weight[i], 4);
    }
}

TEST(Pyramid, OnlyThoseBorrowWhoDoNotKnowTheSize) {
    const Level level = sphere_level(60);
    Measured measured = nothing_measured(level.count());
    const auto put = [&](std::size_t i, double density, float risk) {
        mix({density, risk, risk, 0.5F * risk, level.normal[i], across(level.normal[i], 1), 17}, 1 / risk, i, measured);
    };
    for (std::size_t i = 0; i < level.count(); ++i) put(i, 2, 0.001F);
    measured.risk[7] = measured.error[7] = 0.1F, measured.density[7] = 2.2;  // worse than all, but good enough
    measured.risk[30] = measured.error[30] = 5, measured.density[30] = 40;   // knows nothing
    measured.risk[50] = never, measured.weight[50] = 0, measured.density[50] = NAN;
    borrow(level, std::vector<std::uint8_t>(level.count(), 1), measured, {1, {}});
    EXPECT_EQ(measured.density[7], 2.2);
    EXPECT_NEAR(measured.density[30], 2, 1e-9);
    EXPECT_NEAR(measured.density[50], 2, 1e-9);
    EXPECT_EQ(measured.risk[30], 0.001F);
}
