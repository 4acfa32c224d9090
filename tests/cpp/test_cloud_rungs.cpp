// What a rung of the ladder finds: exact on a sphere for every family, at borders too; and the level sets of spheres of
// the spheres' surface against both passes made one by one.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "../../src/rung_fits.h"
#include "sphere_reference.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

Elements cloud_of(std::size_t count) {
    Elements elements;
    elements.count = count;
    return elements;
}

/// Points that are their own feet; where the surface looks is not known.
Level level_of(const std::vector<Vec3>& points) {
    Level level;
    for (const Vec3 p : points) level.position.insert(level.position.end(), {p.x, p.y, p.z});
    level.foot = level.position;
    level.normal.assign(points.size(), Vec3{NAN, NAN, NAN});
    level.area.assign(points.size(), 1);
    return level;
}

FamilyFlags nobody(std::size_t count) {
    FamilyFlags flags;
    for (std::vector<std::uint8_t>& of_family : flags) of_family.assign(count, 0);
    return flags;
}

struct Place {
    Vec3 normal, foot;
};

/// The others that are nearest to a point.
std::vector<std::size_t> nearest(const std::vector<Vec3>& points, std::size_t i, std::size_t k) {
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t j = 0; j < points.size(); ++j) found.emplace_back(squared(points[j] - points[i]), j);
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> row;
    for (std::size_t j = 0; j < k; ++j)
        if (found[j].second != i) row.push_back(found[j].second);
    return row;
}

/// Sums about a place of a surface, over what of a row is of its sheet and within the radius, in units of that.
SphereSums sums_about(const std::vector<Place>& surface, std::size_t i, const std::vector<std::size_t>& row,
                      const std::vector<float>& weight, double radius) {
    SphereSums sums;
    sums.add({0, 0, 0}, surface[i].normal, double(weight[i]));
    for (const std::size_t j : row) {
        const Vec3 d = 1 / radius * (surface[j].foot - surface[i].foot);
        support::add_if_seen(sums, d, surface[j].normal, surface[i].normal, double(weight[j]));
    }
    return sums;
}

}  // namespace

TEST(RungFits, AreExactOnASphereWithABorder) {
    Random random(1);
    std::vector<Vec3> points;
    while (points.size() < 400) {
        const Vec3 p = unit(Vec3{random.normal(), random.normal(), random.normal()});
        if (p.z > 0.3) points.push_back(p);
    }
    Level level = level_of(points);
    const std::vector<std::uint8_t> active(points.size(), 1);
    const Elements cloud = cloud_of(points.size());
    const FamilyFlags dead = nobody(points.size());
    RungFits fits(cloud, level, active, dead, {});
    // Views settle from rung to rung, and are some 1e-5 off here.
    for (int rung = 0; rung < 2; ++rung) fits.step(rung);
    const Rung found = fits.step(2);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(std::abs(dot(found.normal[i], points[i])), 1, 1e-10);
        for (int f = 0; f < families; ++f) {
            EXPECT_NEAR(found.density[static_cast<std::size_t>(f)][i], 2, 1e-5) << f;
            EXPECT_NEAR(squared_norm(found.tensor[static_cast<std::size_t>(f)][i]), 2, 1e-5) << f;
            EXPECT_NEAR(length(product(found.tensor[static_cast<std::size_t>(f)][i], points[i])), 0, 1e-4) << f;
        }
    }
}

TEST(RungFits, SpheresStandOnTheSurfaceOfSpheresExceptAtBorders) {
    constexpr double one_sided = 0.2;
    constexpr int rung = 0;
    Random random(2);
    std::vector<Vec3> points;
    for (int i = 0; i < 400; ++i) {
        const double u = 2 * random.uniform() - 1, v = 2 * random.uniform() - 1;
        points.push_back({u, v, 0.2 * std::sin(3 * u) + 0.3 * v * v + 0.01 * random.normal()});
    }
    Level level = level_of(points);
    for (float& area : level.area) area = static_cast<float>(0.5 + random.uniform());
    const std::vector<std::uint8_t> active(points.size(), 1);
    const Elements cloud = cloud_of(points.size());
    const FamilyFlags dead = nobody(points.size());
    RungFits fits(cloud, level, active, dead, {});
    const Rung found = fits.step(rung);
    std::vector<Place> quadrics, surface;
    std::vector<std::vector<std::size_t>> rows;
    for (std::size_t i = 0; i < points.size(); ++i) {
        quadrics.push_back({found.normal[i], level.foot_of(i)});
        rows.push_back(nearest(points, i, static_cast<std::size_t>(rung_neighbors(rung))));
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto radius = double(found.size[i]);
        const SphereSums sums = sums_about(quadrics, i, rows[i], level.area, radius);
        const LevelSet through = sums.level_set();
        const Vec3 middle = sums.middle() - dot(sums.middle(), quadrics[i].normal) * quadrics[i].normal;
        const bool cut = length(middle) > one_sided;
        left += cut ? 1 : 0;
        surface.push_back(cut ? quadrics[i]
                              : Place{through.normal, quadrics[i].foot + radius * through.height * through.normal});
    }
    EXPECT_GT(left, 40U);
    EXPECT_LT(left, 300U);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto radius = double(found.size[i]);
        const LevelSet through = sums_about(surface, i, rows[i], level.area, radius).level_set();
        const double truth = squared_norm(through.tensor) / (radius * radius);
        EXPECT_NEAR(found.density[static_cast<int>(Family::sphere)][i], truth, 1e-5 * (1 + truth)) << i;
    }
}

TEST(RungFits, AveragesAreNotFoundWhereNoFamilyAsksForThem) {
    Random random(3);
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i) points.push_back(unit(Vec3{random.normal(), random.normal(), random.normal()}));
    const std::vector<std::uint8_t> active(points.size(), 1);
    const Elements cloud = cloud_of(points.size());
    Level all = level_of(points), some = all;
    const FamilyFlags nobody_dead = nobody(points.size());
    FamilyFlags dead = nobody_dead;
    for (std::size_t i = 0; i < points.size(); i += 2)
        for (const Family family : {Family::quadric, Family::half_mean, Family::mean, Family::half_slope})
            dead[static_cast<std::size_t>(family)][i] = 1;
    for (std::size_t i = 0; i < points.size(); i += 4) dead[static_cast<std::size_t>(Family::slope)][i] = 1;
    RungFits fits_of_all(cloud, all, active, nobody_dead, {}), fits_of_some(cloud, some, active, dead, {});
    const Rung whole = fits_of_all.step(1), part = fits_of_some.step(1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (const Family family : {Family::half_mean, Family::mean, Family::half_slope, Family::slope}) {
            const auto f = static_cast<std::size_t>(family);
            if (i % 4 == 0)
                EXPECT_TRUE(std::isnan(part.density[f][i]) && !std::isnan(whole.density[f][i])) << i;
            else
                EXPECT_EQ(part.density[f][i], whole.density[f][i]) << i;
        }
        for (const Family family : {Family::quadric, Family::quartic, Family::sphere}) {
            const auto f = static_cast<std::size_t>(family);
            EXPECT_EQ(part.density[f][i], whole.density[f][i]) << i;
        }
    }
}
