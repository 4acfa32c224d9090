// What a rung of the ladder finds: exact on a sphere for every family, at borders too; the level sets of spheres of the
// spheres' surface against both passes made one by one, and those of finer samples against theirs.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
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

/// All points on the ladder, with every family.
struct Climb {
    Level level;
    std::vector<std::uint8_t> active;
    Elements cloud;
    FamilyFlags dead;
    FineSurface fine;
    RungFits fits;

    explicit Climb(const std::vector<Vec3>& points)
        : level(level_of(points)),
          active(points.size(), 1),
          cloud(cloud_of(points.size())),
          dead(nobody(points.size())),
          fine(level),
          fits(cloud, level, active, dead, &fine, {}) {}
};

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
    Climb climb(points);
    // Views settle from rung to rung, and are some 1e-5 off here.
    for (int rung = 0; rung < 2; ++rung) climb.fits.step(rung);
    const Rung found = climb.fits.step(2);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(std::abs(dot(found.normal[i], points[i])), 1, 1e-10);
        for (int f = 0; f < static_cast<int>(Family::fine_sphere); ++f) {
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
    Climb climb(points);
    for (float& area : climb.level.area) area = static_cast<float>(0.5 + random.uniform());
    const Rung found = climb.fits.step(rung);
    std::vector<Place> quadrics, surface;
    std::vector<std::vector<std::size_t>> rows;
    for (std::size_t i = 0; i < points.size(); ++i) {
        quadrics.push_back({found.normal[i], climb.level.foot_of(i)});
        rows.push_back(nearest(points, i, static_cast<std::size_t>(rung_neighbors(rung))));
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto radius = double(found.size[i]);
        const SphereSums sums = sums_about(quadrics, i, rows[i], climb.level.area, radius);
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
        const LevelSet through = sums_about(surface, i, rows[i], climb.level.area, radius).level_set();
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
    FineSurface fine_of_all(all), fine_of_some(some);
    RungFits fits_of_all(cloud, all, active, nobody_dead, &fine_of_all, {}),
        fits_of_some(cloud, some, active, dead, &fine_of_some, {});
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

namespace {

/// A torus's shape operator squared, at a place beside it.
double density_of_torus(Vec3 p, double around, double tube) {
    const double from_axis = std::hypot(p.x, p.y), cosine = (from_axis - around) / std::hypot(from_axis - around, p.z);
    return 1 / (tube * tube) + std::pow(cosine / (around + tube * cosine), 2);
}

std::vector<Vec3> on_torus(Random& random, double around, double tube, std::size_t count) {
    std::vector<Vec3> points;
    while (points.size() < count) {
        const double u = 2 * std::numbers::pi * random.uniform(), v = 2 * std::numbers::pi * random.uniform();
        const double r = around + tube * std::cos(v);
        if (random.uniform() * (around + tube) < r)
            points.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
    }
    return points;
}

}  // namespace

TEST(FineSpheres, StandOnTheSurfaceOfAThirdAndExtrapolate) {
    // Against level sets made one by one, of all points as the rung with a third of the neighbours left them.
    constexpr int rung = 3;
    Random random(4);
    const std::vector<Vec3> points = on_torus(random, 1, 0.5, 600);
    Climb climb(points);
    std::vector<Place> surface;
    const Rung first = climb.fits.step(rung - FineSurface::rungs_below);
    for (std::size_t i = 0; i < points.size(); ++i) surface.push_back({first.normal[i], climb.level.foot_of(i)});
    for (int r = rung - FineSurface::rungs_below + 1; r < rung; ++r) climb.fits.step(r);
    std::vector<Vec3> before;
    for (std::size_t i = 0; i < points.size(); ++i) before.push_back(climb.level.foot_of(i));
    const Rung found = climb.fits.step(rung);
    std::size_t seen = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::vector<std::size_t> row(points.size());
        std::iota(row.begin(), row.end(), 0u);
        const auto away = [&](std::size_t j) { return squared(points[j] - before[i]); };
        std::sort(row.begin(), row.end(), [&](std::size_t a, std::size_t b) { return away(a) < away(b); });
        row.resize(static_cast<std::size_t>(rung_neighbors(rung)));
        const auto shape = [&](double radius) {
            SphereSums sums;
            const Place& own = surface[i];
            if (std::find(row.begin(), row.end(), i) == row.end()) row.push_back(i);
            for (const std::size_t j : row) {
                const Vec3 d = 1 / radius * (surface[j].foot - own.foot);
                if (!(squared(d) < 1)) continue;
                const double side = dot(surface[j].normal, support::expected_normal(d, own.normal)) < 0 ? -1 : 1;
                sums.add(d, side * surface[j].normal, 1);
            }
            const LevelSet through = sums.level_set();
            const Symmetric3 s = carried(through.tensor, through.normal, own.normal);
            // Curvatures of a parallel surface: 1 / k grows by the height.
            const double h = through.height, sum = s.xx + s.yy + s.zz, product = 0.5 * (sum * sum - squared_norm(s)),
                         stretch = 1 + h * sum + h * h * product;
            Symmetric3 parallel;
            add(parallel, 1 / stretch, s);
            const Vec3 n = own.normal;
            const Frame frame = frame_about(n);
            add(parallel, h * product / stretch, in_plane(frame, 1, 0, 1));
            Symmetric3 tensor;
            add(tensor, 1 / radius, carried(parallel, n, found.normal[i]));
            return tensor;
        };
        const Symmetric3 whole = shape(double(found.size[i])), half = shape(double(found.half_size[i]));
        if (std::isnan(found.density[static_cast<int>(Family::extrapolated)][i])) continue;
        ++seen;
        Symmetric3 extrapolated;
        add(extrapolated, 2, half);
        add(extrapolated, -1, whole);
        const double of_whole = squared_norm(whole), of_both = squared_norm(extrapolated);
        EXPECT_NEAR(found.density[static_cast<int>(Family::fine_sphere)][i], of_whole, 1e-5 * (1 + of_whole)) << i;
        EXPECT_NEAR(found.density[static_cast<int>(Family::extrapolated)][i], of_both, 1e-5 * (1 + of_both)) << i;
    }
    EXPECT_GT(seen, points.size() * 9 / 10);
}

TEST(FineSpheres, AreCloserThanSpheresOfWideWindows) {
    // Without noise what is left is bias: of the rung's own quadrics that of wide windows.
    Random random(5);
    const std::vector<Vec3> points = on_torus(random, 1, 0.6, 2000);
    Climb climb(points);
    Rung found;
    for (int rung = 0; rung <= 6; ++rung) found = climb.fits.step(rung);
    double wide = 0, closer = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double truth = density_of_torus(points[i], 1, 0.6);
        wide += std::pow(double(found.density[static_cast<int>(Family::sphere)][i]) - truth, 2);
        closer += std::pow(double(found.density[static_cast<int>(Family::fine_sphere)][i]) - truth, 2);
    }
    EXPECT_LT(closer, 0.5 * wide);
}

TEST(FineSurface, FollowsTheElementsOfCoarserLevels) {
    Random random(6);
    const std::vector<Vec3> points = on_torus(random, 1, 0.5, 500);
    Level lowest = level_of(points);
    for (std::size_t i = 0; i < points.size(); ++i) lowest.normal[i] = unit(points[i]);
    lowest.graph.index.assign(points.size() * ElementGraph::degree, -1);
    FineSurface fine(lowest);
    const CoarserLevel coarser = coarsened(lowest, 0, {});
    fine.coarsen(coarser);
    const Level& above = coarser.level;
    std::vector<int> times(points.size(), 0);
    for (std::size_t e = 0; e < above.count(); ++e) {
        EXPECT_EQ(fine.representative(e), static_cast<std::size_t>(coarser.representative[e]));
        for (const std::int32_t* member = fine.begin(e); member != fine.end(e); ++member) {
            EXPECT_EQ(coarser.parent[static_cast<std::size_t>(*member)], static_cast<std::int32_t>(e));
            ++times[static_cast<std::size_t>(*member)];
        }
    }
    EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](int n) { return n == 1; }));
    // Samples lie on the element's quadric: of a plane, on the plane, of its normal.
    Rung found(above.count());
    const std::vector<std::uint8_t> active(above.count(), 1);
    for (std::size_t e = 0; e < above.count(); ++e) found.normal[e] = {0, 0, 1}, found.size[e] = 1;
    found.tensor[static_cast<int>(Family::quadric)].assign(above.count(), {0.2, 0, 0, 0.4, 0, 0});
    fine.keep(4, above, active, found, {});
    const Surface& surface = fine.for_rung(4 + FineSurface::rungs_below);
    for (std::size_t j = 0; j < points.size(); ++j) {
        const Vec3 foot = above.foot_of(static_cast<std::size_t>(coarser.parent[j])), d = lowest.foot_of(j) - foot;
        const Vec3 expected = foot + Vec3{d.x, d.y, -0.1 * d.x * d.x - 0.2 * d.y * d.y};
        EXPECT_NEAR(length(load(surface[j].foot) - expected), 0, 1e-12);
        EXPECT_NEAR(length(load(surface[j].normal) - unit(Vec3{0.2 * d.x, 0.4 * d.y, 1})), 0, 1e-12);
        EXPECT_EQ(surface[j].weight, 1);
    }
}
