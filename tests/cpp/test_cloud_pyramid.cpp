// What is mixed, lent and handed down between elements and levels of the ladder: against sums over all estimates, and
// on a sphere whose coarse level knows better.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "../../src/frame.h"
#include "../../src/pyramid.h"
#include "gaussmap/neighbors.h"
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
    double sum = 0, weights = 0, curvature = 0, squares = 0;
    float best = never;
    for (int e = 0; e < 9; ++e) {
        const double k = 1 + 0.1 * random.normal(), weight = e == 4 ? 0 : random.uniform();
        const float risk = e == 4 ? 0 : static_cast<float>(0.1 + random.uniform());
        // Either side of the surface.
        const double side = e % 2 == 0 ? 1 : -1;
        const auto apart = static_cast<float>(random.uniform());
        mix({2 * k * k, risk, 2 * risk, 0.5F * risk, apart, 1 + risk, side * pole, across(pole, side * k),
             static_cast<std::uint8_t>(e)},
            weight, 0, measured);
        sum += weight * 2 * k * k, weights += weight, curvature += weight * k;
        squares += weight * (4 * k * k * k * k + apart);
        if (weight > 0) best = std::min(best, risk);
        EXPECT_NEAR(measured.density[0], sum / weights, 1e-12);
        EXPECT_EQ(measured.risk[0], best) << "an estimate without weight is none";
        EXPECT_EQ(measured.error[0], 2 * best);
        EXPECT_EQ(measured.noise[0], 0.5F * best);
        EXPECT_EQ(measured.cut[0], 1 + best);
        EXPECT_NEAR(measured.disagreement[0], squares / weights - std::pow(sum / weights, 2), 1e-6);
        EXPECT_NEAR(measured.tensor[0].xx * measured.normal[0].z, curvature / weights, 1e-12);
    }
    EXPECT_NEAR(measured.weight[0], weights, 1e-12);
}

TEST(Pyramid, AreasCountTheElementsThatAreNearest) {
    const Level lowest = sphere_level(600);
    const Level middle = coarsened(lowest, 0, {1, {}}).level, top = coarsened(middle, 0, {1, {}}).level;
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

TEST(Pyramid, GroupingsDifferByWhereGroupsBegin) {
    const Level lowest = sphere_level(601);
    const std::vector<std::int32_t> order = spatial_order(Points(lowest.foot), {1, {}});
    for (int grouping = 0; grouping < Level::group; ++grouping) {
        const CoarserLevel coarser = coarsened(lowest, grouping, {1, {}});
        ASSERT_EQ(coarser.representative.size(), 201U);
        // The middle of each group is one of it.
        std::size_t at = 0;
        for (std::size_t g = 0; g < 201; ++g) {
            const std::size_t size =
                g == 0 ? 3 - static_cast<std::size_t>(grouping) : std::min<std::size_t>(3, 601 - at);
            const auto group = std::span(order).subspan(at, size);
            EXPECT_NE(std::find(group.begin(), group.end(), coarser.representative[g]), group.end()) << g;
            at += size;
        }
        EXPECT_EQ(at, 601U);
    }
}

/// What coarser levels found, off by so much, of which risk and weight.
CoarserLevel found(const Level& fine, int grouping, double off, float risk, double weight) {
    CoarserLevel coarser = coarsened(fine, grouping, {1, {}});
    const Level& level = coarser.level;
    for (std::size_t g = 0; g < level.count(); ++g)
        mix({density_at(level.foot_of(g)) + off, risk, 2 * risk, 0.5F * risk, 0, 1, level.normal[g],
             across(level.normal[g], 1), 20},
            weight, g, coarser.measured);
    return coarser;
}

/// On a fine level that is off by 0.4 everywhere, of weight 1.
Measured refined(const Level& fine, const std::vector<CoarserLevel>& groupings) {
    Measured below = nothing_measured(fine.count());
    for (std::size_t i = 0; i < fine.count(); ++i)
        mix({density_at(fine.foot_of(i)) + 0.4, 0.1F, 0.2F, 0.05F, 0, 1, fine.normal[i], across(fine.normal[i], 1), 17},
            1, i, below);
    refine(groupings, fine, below, {1, {}});
    return below;
}

TEST(Pyramid, WhatCoarserLevelsFoundIsMixedIn) {
    const Level fine = sphere_level(600);
    const Measured below = refined(fine, {found(fine, 0, 0, 0.01F, 3)});
    for (std::size_t i = 0; i < fine.count(); ++i) {
        // A quarter of the fine level's error is left, and what interpolation between coarse ones errs.
        EXPECT_NEAR(below.density[i], density_at(fine.foot_of(i)) + 0.1, 0.02) << i;
        EXPECT_EQ(below.choice[i], 20);
        EXPECT_EQ(below.error[i], 0.02F);
        EXPECT_EQ(below.noise[i], 0.005F);
        EXPECT_NEAR(below.disagreement[i], 0.03, 0.01);  // 3/4 · 1/4 · 0.4²
        EXPECT_DOUBLE_EQ(below.weight[i], 4);
    }
}

TEST(Pyramid, GroupingsCountAlike) {
    const Level fine = sphere_level(600);
    // Whatever they promise: both have the mean weight of 1 and 5.
    const Measured below = refined(fine, {found(fine, 0, 0.2, 0.01F, 1), found(fine, 1, -0.2, 0.001F, 5)});
    for (std::size_t i = 0; i < fine.count(); ++i) {
        EXPECT_NEAR(below.density[i], density_at(fine.foot_of(i)) + 0.1, 0.02) << i;
        EXPECT_EQ(below.error[i], 0.002F);
        EXPECT_DOUBLE_EQ(below.weight[i], 4);
    }
}

TEST(Pyramid, OnlyThoseBorrowWhoDoNotKnowTheSize) {
    const Level level = sphere_level(60);
    Measured measured = nothing_measured(level.count());
    const auto put = [&](std::size_t i, double density, float risk) {
        mix({density, risk, risk, 0.5F * risk, 0, 1, level.normal[i], across(level.normal[i], 1), 17}, 1 / risk, i,
            measured);
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
