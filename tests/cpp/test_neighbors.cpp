// Nearest neighbours against brute force, and clouds without repetitions.
#include "gaussmap/neighbors.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "clouds.h"
#include "nearest_reference.h"

using namespace gaussmap;
using support::brute_force;
using support::Random;
using support::random_points;
using support::refusal;

namespace {

void expect_exact(const std::vector<double>& points, int k, const char* what) {
    const Neighbors found = nearest_neighbors(points, k);
    EXPECT_EQ(found.k, static_cast<std::size_t>(k)) << what;
    EXPECT_EQ(found.count(), points.size() / 3) << what;
    EXPECT_EQ(found.index, brute_force(points, k).index) << what << ", k = " << k;
}

}  // namespace

TEST(NearestNeighbors, RandomPointsAsBruteForce) {
    for (const int k : {1, 2, 7, 20, 50}) expect_exact(random_points(1000, 1), k, "cube");
    for (const std::size_t n : {2, 3, 15, 16, 17, 31, 32, 33, 100, 257}) expect_exact(random_points(n, n), 8, "small");
    for (const int k : {1, 3, 5, 10, 16, 31, 32, 33, 64, 100, 200, 300}) {
        expect_exact(random_points(700, 18), k, "cube");
        expect_exact(support::sphere_cloud(1, 600, 19).points, k, "sphere");
    }
    expect_exact(support::sphere_cloud(3, 1000, 2).points, 20, "sphere");
    expect_exact(support::torus_cloud(1, 0.5, 0.12, 3).points, 20, "torus");
}

TEST(NearestNeighbors, TiesGoToTheLowerIndex) {
    std::vector<double> grid;
    for (int i = 0; i < 9 * 9 * 9; ++i) grid.insert(grid.end(), {double(i % 9), double(i / 9 % 9), double(i / 81)});
    for (const int k : {3, 6, 20, 26, 90, 300}) expect_exact(grid, k, "grid");
    Random random(4);
    for (std::size_t i = 0; i < grid.size() / 3; ++i)
        for (int c = 0; c < 3; ++c) std::swap(grid[3 * i + c], grid[3 * random.below(grid.size() / 3) + c]);
    expect_exact(grid, 20, "shuffled lattice with repetitions");
}

TEST(NearestNeighbors, RepeatedAndDegeneratePoints) {
    Random random(5);
    std::vector<double> repeated = random_points(30, 6), line, equal, clusters;
    for (int copy = 0; copy < 5; ++copy) repeated.insert(repeated.end(), repeated.begin(), repeated.begin() + 90);
    for (int i = 0; i < 600; ++i) {
        const double t = std::floor(200 * random.uniform());
        line.insert(line.end(), {t, 2 * t, -t});
        equal.insert(equal.end(), {1.5, -2, 0.25});
        const double far = i % 3 == 0 ? 1e9 : 0;
        clusters.insert(clusters.end(), {far + random.uniform(), random.uniform(), far + random.uniform()});
    }
    for (const int k : {1, 4, 5, 6, 20, 120}) {
        expect_exact(repeated, k, "six copies of each");
        expect_exact(line, k, "line");
        expect_exact(equal, k, "all equal");
        expect_exact(clusters, k, "two far clusters");
    }
}

TEST(NearestNeighbors, AnyMagnitude) {
    std::vector<double> far = random_points(500, 7);
    for (double& v : far) v += 4e6;
    expect_exact(far, 20, "far from the origin");
    for (double& v : far) v += 1e15;
    expect_exact(far, 20, "so far that the places round to a few");
    expect_exact(random_points(300, 8, 1e-200), 10, "squares underflow");
    std::vector<double> huge = random_points(300, 9, 1e300);
    for (std::size_t i = 0; i < huge.size(); i += 2) huge[i] = -huge[i];
    expect_exact(huge, 10, "squares overflow");
}

TEST(NearestNeighbors, FewerOthersThanAskedFor) {
    expect_exact(random_points(5, 10), 4, "exactly all");
    expect_exact(random_points(5, 11), 12, "more than all");
    EXPECT_EQ(nearest_neighbors(Points(), 3).count(), 0u);
    const std::vector<double> one = {1, 2, 3};
    EXPECT_EQ(nearest_neighbors(one, 2).index, (std::vector<std::int32_t>{-1, -1}));
    const std::vector<double> two = {0, 0, 0, 1, 0, 0};
    EXPECT_EQ(nearest_neighbors(two, 2).index, (std::vector<std::int32_t>{1, -1, 0, -1}));
}

/// Large enough that anything quadratic would not end; the answers are known.
TEST(NearestNeighbors, ManyEqualPointsAreNotSlow) {
    const std::size_t n = 60000;
    std::vector<double> points(3 * n, 0.5);
    const Neighbors equal = nearest_neighbors(points, 20);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < 20; ++j)
            ASSERT_EQ(equal[i][j], static_cast<std::int32_t>(i <= j ? j + 1 : j)) << "row " << i;
    for (std::size_t i = 0; i < n; ++i) points[3 * i] = static_cast<double>(i % 2000);
    const Neighbors piles = nearest_neighbors(points, 20);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < 20; ++j) {
            const std::size_t pile = i % 2000, place = i / 2000;
            ASSERT_EQ(piles[i][j], static_cast<std::int32_t>(pile + 2000 * (place <= j ? j + 1 : j))) << "row " << i;
        }
}

/// Sparse after dense and dense after sparse: a radius that was typical a moment ago is of no use.
TEST(NearestNeighbors, DensityThatJumps) {
    Random random(20);
    std::vector<double> points, spiral;
    for (int i = 0; i < 1500; ++i) {
        const double size = std::pow(10, -static_cast<double>(random.below(9)));
        for (int c = 0; c < 3; ++c)
            points.push_back(size * random.normal() + (c == 0 ? static_cast<double>(i % 3) : 0));
    }
    for (int i = -500; i < 500; ++i) spiral.insert(spiral.end(), {std::ldexp(1, i), -std::ldexp(1, i), 0});
    for (const int k : {1, 20, 150}) {
        expect_exact(points, k, "clusters within clusters");
        expect_exact(spiral, k, "powers of two");
    }
}

TEST(NearestNeighbors, FollowAPermutationOfThePoints) {
    const std::vector<double> points = support::torus_cloud(1, 0.4, 0.05, 21).points;
    const std::size_t n = points.size() / 3;
    Random random(22);
    std::vector<std::int32_t> to(n);
    std::iota(to.begin(), to.end(), 0);
    for (std::size_t i = n; i > 1; --i) std::swap(to[i - 1], to[random.below(i)]);
    std::vector<double> moved(points.size());
    for (std::size_t i = 0; i < n; ++i) std::copy_n(&points[3 * i], 3, &moved[3 * static_cast<std::size_t>(to[i])]);
    const Neighbors before = nearest_neighbors(points, 20), after = nearest_neighbors(moved, 20);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < 20; ++j)
            ASSERT_EQ(after[static_cast<std::size_t>(to[i])][j], to[static_cast<std::size_t>(before[i][j])]);
}

/// From the centre everything on the sphere is as near; only what is in the centre itself may be looked at.
TEST(NearestNeighbors, ManyCopiesInTheCentreOfASphereAreNotSlow) {
    const std::vector<double> sphere = support::sphere_cloud(1, 30000, 23).points;
    std::vector<double> points;
    for (std::size_t i = 0; i < 30000; ++i) {
        points.insert(points.end(), &sphere[3 * i], &sphere[3 * i] + 3);
        points.insert(points.end(), {0, 0, 0});
    }
    const Neighbors found = nearest_neighbors(points, 20);
    for (std::size_t i = 0; i < 30000; ++i)
        for (std::size_t j = 0; j < 20; ++j)
            ASSERT_EQ(found[2 * i + 1][j], static_cast<std::int32_t>(2 * (i <= j ? j + 1 : j) + 1)) << "copy " << i;
}

TEST(NearestNeighbors, SameForAnyNumberOfThreads) {
    const std::vector<double> points = support::torus_cloud(1, 0.4, 0.03, 13).points;
    const Neighbors one = nearest_neighbors(points, 20, {1, {}});
    EXPECT_EQ(one.index, nearest_neighbors(points, 20, {2, {}}).index);
    EXPECT_EQ(one.index, nearest_neighbors(points, 20, {7, {}}).index);
}

TEST(NearestNeighbors, ReportsProgressAndCanBeCancelled) {
    const std::vector<double> points = random_points(20000, 14);
    double last = 0;
    nearest_neighbors(points, 5, {1, [&](double done) {
                                      EXPECT_GE(done, last);
                                      last = done;
                                      return true;
                                  }});
    EXPECT_DOUBLE_EQ(last, 1);
    EXPECT_THROW(nearest_neighbors(points, 5, {1, [](double done) { return done < 0.5; }}), Cancelled);
}

TEST(NearestNeighbors, RefusesWhatItCannotDo) {
    std::vector<double> points = random_points(10, 15);
    EXPECT_EQ(refusal([&] { nearest_neighbors(points, 0); }), "k = 0 is too small; ask for at least 1 neighbour");
    points[3 * 4 + 1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(refusal([&] { nearest_neighbors(points, 3); }), "points[4] is not finite; leave such points out first");
    const Points endless(points.data(), std::size_t(1) << 31);
    EXPECT_EQ(refusal([&] { nearest_neighbors(endless, 3); }),
              "points has 2147483648 entries, more than 2147483647; split the cloud");
    EXPECT_EQ(refusal([&] { distinct_points(endless); }),
              "points has 2147483648 entries, more than 2147483647; split the cloud");
}

TEST(DistinctPoints, KeepsTheFirstHolderOfEachPosition) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    const std::vector<double> points = {1, 2, 3, nan, 0, 0, 0.0, 0, 0, 1, 2, 3, -0.0, 0, -0.0, 0, 0, inf, 3, 2, 1};
    const DistinctPoints distinct = distinct_points(points);
    EXPECT_EQ(distinct.points, (std::vector<double>{1, 2, 3, 0, 0, 0, 3, 2, 1}));
    EXPECT_EQ(distinct.source, (std::vector<std::int32_t>{0, 2, 6}));
    EXPECT_EQ(distinct.target, (std::vector<std::int32_t>{0, -1, 1, 0, 1, -1, 2}));
    EXPECT_EQ(distinct.duplicates, 2u);
    EXPECT_EQ(distinct.non_finite, 2u);
    EXPECT_TRUE(distinct_points(Points()).source.empty());
}

TEST(DistinctPoints, ManyPositionsAndCopies) {
    Random random(16);
    const std::vector<double> positions = random_points(5000, 17);
    std::vector<double> points;
    std::vector<std::size_t> drawn;
    for (int i = 0; i < 20000; ++i) {
        drawn.push_back(random.below(5000));
        points.insert(points.end(), &positions[3 * drawn.back()], &positions[3 * drawn.back()] + 3);
    }
    const DistinctPoints distinct = distinct_points(points);
    EXPECT_EQ(distinct.source.size() + distinct.duplicates, drawn.size());
    std::vector<std::int32_t> first(5000, -1);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (first[drawn[i]] < 0) first[drawn[i]] = static_cast<std::int32_t>(i);
        ASSERT_EQ(distinct.source[static_cast<std::size_t>(distinct.target[i])], first[drawn[i]]) << "input " << i;
    }
    EXPECT_TRUE(std::is_sorted(distinct.source.begin(), distinct.source.end()));
}
