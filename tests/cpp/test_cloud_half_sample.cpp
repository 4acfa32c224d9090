// What half of the elements tell of the errors of first looks, against halves made and looked at one by one.
#include <algorithm>
#include <cmath>
#include <utility>

#include "../../src/automatic.h"
#include "../../src/half_sample.h"
#include "clouds.h"
#include "gaussmap/neighbors.h"
#include "nearest_reference.h"

using namespace gaussmap;

namespace {

using Array = std::vector<double>;

/// A cloud's points along the space-filling curve.
support::Cloud along_the_curve(const support::Cloud& cloud) {
    support::Cloud ordered;
    for (const std::int32_t i : spatial_order(cloud.points)) {
        const auto at = static_cast<std::size_t>(i);
        const double *p = &cloud.points[3 * at], *n = &cloud.normals[3 * at];
        ordered.add({p[0], p[1], p[2]}, {n[0], n[1], n[2]}, cloud.density[at]);
    }
    return ordered;
}

/// Neighbours by comparing all with all.
Elements elements_of(const Array& points, bool connected = false) {
    Elements elements;
    elements.count = points.size() / 3;
    elements.connected = connected;
    elements.position = [&points](std::size_t i) { return load(&points[3 * i]); };
    elements.neighbors = [&points](std::size_t first, std::size_t last, int k, std::int32_t* rows) {
        for (std::size_t i = first; i < last; ++i) {
            const Array here(&points[3 * i], &points[3 * i] + 3);
            for (const std::int32_t j : support::brute_force(points, here, k + 1).index)
                if (j != static_cast<std::int32_t>(i)) *rows++ = j;
        }
    };
    return elements;
}

double diagonal(const Elements& elements) {
    Vec3 low = elements[0], high = low;
    for (std::size_t i = 0; i < elements.count; ++i) {
        const Vec3 p = elements[i];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return length(high - low);
}

double factor(const Array& points, const Array& density, int threads = 0, bool connected = false) {
    const Elements elements = elements_of(points, connected);
    return told_error_factor(elements, diagonal(elements), [&](std::size_t i) { return density[i]; }, {threads, {}});
}

/// Looks at every other point alone.
AutomaticCurvature look_at_half(const Array& points) {
    Array half;
    for (std::size_t i = 0; i < points.size(); i += 6) half.insert(half.end(), &points[i], &points[i] + 3);
    return automatic_curvature(elements_of(half), diagonal(elements_of(points)), {1, {}});
}

/// The 95th percentile of what the half is off, in pairs of the errors that it tells.
double off_by(const Array& points, const Array& density) {
    const AutomaticCurvature found = look_at_half(points);
    Array ratios;
    for (std::size_t i = 0; i < found.density.size(); ++i)
        ratios.push_back(std::abs(found.density[i] - density[2 * i]) / (2 * found.error[i]));
    std::sort(ratios.begin(), ratios.end());
    return ratios[ratios.size() * 95 / 100];
}

support::Cloud clean() {
    return along_the_curve(support::torus_cloud(1, 0.4, 0.07, 1));
}

}  // namespace

TEST(HalfSample, TellsWhatAHalfMadeByItselfTells) {
    for (const support::Cloud& cloud : {clean(), along_the_curve(support::ellipsoid_cloud(1, 0.8, 0.7, 2501, 2))}) {
        const double off = off_by(cloud.points, cloud.density), told = factor(cloud.points, cloud.density);
        ASSERT_GT(off, 0.6);
        ASSERT_LT(off, 1.1) << "else the limits of the factor would be all that is tested";
        EXPECT_NEAR(told, 1.15 * off, 0.01);
        EXPECT_EQ(factor(cloud.points, cloud.density, 0, true), told) << "asked for one by one";
    }
}

TEST(HalfSample, StaysWithinItsLimits) {
    const support::Cloud cloud = clean();
    const AutomaticCurvature found = look_at_half(cloud.points);
    // Densities that are as far from those of the half as this many of the errors it tells.
    const auto off_by_errors = [&](double errors) {
        Array density(cloud.count());
        for (std::size_t i = 0; i < density.size(); i += 2)
            density[i] = found.density[i / 2] + errors * found.error[i / 2];
        return factor(cloud.points, density);
    };
    EXPECT_EQ(off_by_errors(0.4), 0.65);
    EXPECT_NEAR(off_by_errors(2), 1.15, 0.01);
    EXPECT_EQ(off_by_errors(2.8), 1.25);
    EXPECT_EQ(off_by_errors(3.5), 1) << "another shape";
}

TEST(HalfSample, SaysNothingOfNoiseGridsAndFewPoints) {
    support::Cloud cloud = clean();
    const double told = factor(cloud.points, cloud.density);
    ASSERT_NE(told, 1);
    Array density = cloud.density;
    for (std::size_t i = 0; i < density.size(); i += 18) density[i] = NAN;  // of those looked at every ninth
    EXPECT_EQ(factor(cloud.points, density), 1);
    for (std::size_t i = 0; i < density.size(); i += 36) density[i] = cloud.density[i];
    EXPECT_NEAR(factor(cloud.points, density), told, 0.05) << "half as many do no harm";
    support::Random random(4);
    for (double& x : cloud.points) x += 0.005 * random.normal();
    EXPECT_EQ(factor(cloud.points, cloud.density), 1);
    const support::Cloud few = along_the_curve(support::torus_cloud(1, 0.4, 0.22, 1));
    ASSERT_LT(few.count(), 400u);
    EXPECT_EQ(factor(few.points, few.density), 1);
}

TEST(HalfSample, LooksAtSomeOfManyWithAnyNumberOfThreads) {
    // A bent sheet, not quite a grid, on which neighbours are found without a search.
    constexpr std::size_t side = 256;
    Elements sheet;
    sheet.count = side * side;
    std::vector<std::int32_t> cell(sheet.count);  // along the curve
    for (std::size_t i = 0; i < sheet.count; ++i) {
        std::size_t x = 0, y = 0;
        for (std::size_t bit = 0; bit < 8; ++bit) x |= (i >> 2 * bit & 1) << bit, y |= (i >> (2 * bit + 1) & 1) << bit;
        cell[i] = static_cast<std::int32_t>(y * side + x);
    }
    std::vector<std::int32_t> rank(sheet.count);
    for (std::size_t i = 0; i < sheet.count; ++i)
        rank[static_cast<std::size_t>(cell[i])] = static_cast<std::int32_t>(i);
    support::Random random(5);
    Array x(sheet.count), y(sheet.count);
    for (std::size_t i = 0; i < sheet.count; ++i) {
        const int column = cell[i] % static_cast<int>(side), row = cell[i] / static_cast<int>(side);
        x[i] = column + 0.5 * random.uniform();
        y[i] = row + 0.5 * random.uniform();
    }
    sheet.position = [&](std::size_t i) { return Vec3{x[i], y[i], 2 * std::sin(x[i] / 5) * std::cos(y[i] / 6)}; };
    sheet.neighbors = [&](std::size_t first, std::size_t last, int k, std::int32_t* rows) {
        ASSERT_EQ(first % Elements::block, 0u);
        std::vector<std::pair<double, std::int32_t>> others;
        for (std::size_t i = first; i < last; ++i, rows += k) {
            others.clear();
            const int column = cell[i] % static_cast<int>(side), row = cell[i] / static_cast<int>(side);
            for (int r = std::max(0, row - 7); r < std::min<int>(side, row + 8); ++r)
                for (int c = std::max(0, column - 7); c < std::min<int>(side, column + 8); ++c) {
                    const std::int32_t j = rank[static_cast<std::size_t>(r) * side + static_cast<std::size_t>(c)];
                    const Vec3 d = sheet.position(static_cast<std::size_t>(j)) - sheet.position(i);
                    if (static_cast<std::size_t>(j) != i) others.emplace_back(dot(d, d), j);
                }
            std::sort(others.begin(), others.end());
            std::fill_n(rows, k, -1);
            for (std::size_t j = 0; j < std::min(others.size(), static_cast<std::size_t>(k)); ++j)
                rows[j] = others[j].second;
        }
    };
    const AutomaticCurvature whole = automatic_curvature(sheet, 370, {0, {}});
    std::vector<std::size_t> asked;
    const auto density = [&](std::size_t i) {
        asked.push_back(i);
        return whole.density[i] + 4 * whole.error[i];  // else it would be the least of all factors
    };
    const double told = told_error_factor(sheet, 370, density, {1, {}});
    EXPECT_GT(told, 0.65);
    EXPECT_LT(told, 1.25);
    EXPECT_NE(told, 1);
    EXPECT_EQ(asked.size(), 16384u) << "of 32,768";
    EXPECT_TRUE(std::is_sorted(asked.begin(), asked.end()));
    EXPECT_EQ(std::adjacent_find(asked.begin(), asked.end()), asked.end()) << "none twice";
    EXPECT_GT(asked.back(), sheet.count * 7 / 8);
    for (const int threads : {2, 7}) EXPECT_EQ(told_error_factor(sheet, 370, density, {threads, {}}), told);
}
