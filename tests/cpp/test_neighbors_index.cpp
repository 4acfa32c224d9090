// The index: queries at any place against brute force, and the kernels for each instruction set against each other.
#include <limits>

#include "../../src/neighbor_search.h"
#include "clouds.h"
#include "nearest_reference.h"

using namespace gaussmap;
using support::brute_force;
using support::Random;
using support::random_points;
using support::refusal;

namespace {

void expect_exact(const std::vector<double>& points, const std::vector<double>& queries, int k, const char* what) {
    const NeighborIndex index(points);
    const NearestPoints found = index.nearest(queries, k, true), truth = brute_force(points, queries, k);
    EXPECT_EQ(found.k, truth.k) << what;
    EXPECT_EQ(found.index, truth.index) << what << ", k = " << k;
    EXPECT_TRUE(support::same_bits(found.squared_distance, truth.squared_distance)) << what << ", k = " << k;
}

}  // namespace

TEST(NeighborIndex, QueriesAnywhereAsBruteForce) {
    const std::vector<double> torus = support::torus_cloud(1, 0.5, 0.1, 1).points, inside = random_points(300, 2, 2);
    std::vector<double> outside = random_points(300, 3, 100);
    for (double& v : outside) v -= 50;
    std::vector<double> mixed = torus;
    mixed.insert(mixed.end(), outside.begin(), outside.end());
    mixed.insert(mixed.end(), {1e300, -1e300, 0, 1e150, 1e160, 0, 0, 0, 0});
    for (const int k : {1, 2, 20, 75, 300}) {
        expect_exact(torus, inside, k, "among the points");
        expect_exact(torus, outside, k, "far outside");
        expect_exact(torus, mixed, k, "the points themselves and far ones");
    }
}

TEST(NeighborIndex, TiesGoToTheLowerIndex) {
    std::vector<double> grid, corners;
    for (int i = 0; i < 8 * 8 * 8; ++i) {
        grid.insert(grid.end(), {double(i % 8), double(i / 8 % 8), double(i / 64)});
        corners.insert(corners.end(), {i % 8 + 0.5, i / 8 % 8 + 0.5, i / 64 + 0.5});
    }
    grid.insert(grid.end(), grid.begin(), grid.begin() + 300);
    for (const int k : {1, 5, 8, 16, 40}) expect_exact(grid, corners, k, "middles of cells");
    expect_exact(std::vector<double>(3 * 500, 0.5), corners, 30, "one place");
}

TEST(NeighborIndex, EveryCountOfPointsAndQueries) {
    for (const std::size_t n : {1, 2, 15, 16, 17, 127, 128, 129, 1025})
        for (const std::size_t queries : {0, 1, 15, 16, 17, 33})
            for (const int k : {1, 18})
                expect_exact(random_points(n, n), random_points(queries, 100 + queries), k, "few");
    const std::vector<double> five = random_points(5, 4);
    EXPECT_EQ(NeighborIndex(five).count(), 5u);
    const NearestPoints none = NeighborIndex(Points()).nearest(five, 3, true);
    EXPECT_EQ(none.index, std::vector<std::int32_t>(15, -1));
    EXPECT_EQ(none.squared_distance, std::vector<double>(15, std::numeric_limits<double>::infinity()));
}

TEST(NeighborIndex, DistancesOnRequest) {
    const std::vector<double> points = random_points(100, 6);
    const NeighborIndex index(points);
    const NearestPoints with = index.nearest(points, 4, true), without = index.nearest(points, 4);
    EXPECT_EQ(with.index, without.index);
    EXPECT_TRUE(without.squared_distance.empty());
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_EQ(with.index[4 * i], static_cast<std::int32_t>(i));
        EXPECT_EQ(with.squared_distance[4 * i], 0);
    }
}

TEST(NeighborIndex, SameForAnyNumberOfThreads) {
    const std::vector<double> points = support::torus_cloud(1, 0.4, 0.02, 7).points, queries = random_points(30000, 8);
    const NearestPoints one = NeighborIndex(points, {1, {}}).nearest(queries, 20, true, {1, {}});
    for (const int threads : {2, 7}) {
        const NearestPoints more = NeighborIndex(points, {threads, {}}).nearest(queries, 20, true, {threads, {}});
        EXPECT_EQ(one.index, more.index);
        EXPECT_TRUE(support::same_bits(one.squared_distance, more.squared_distance));
    }
}

TEST(NeighborIndex, OutlivesThePointsAndIsShared) {
    std::vector<double> points = random_points(50, 9);
    const NearestPoints before = NeighborIndex(points).nearest(points, 3);
    const std::vector<double> queries = points;
    const NeighborIndex index(points), copy = index;
    points.assign(points.size(), 0);
    EXPECT_EQ(copy.nearest(queries, 3).index, before.index);
}

TEST(NeighborIndex, RefusesWhatItCannotDo) {
    std::vector<double> points = random_points(10, 10), queries = points;
    const NeighborIndex index(points);
    EXPECT_EQ(refusal([&] { index.nearest(queries, 0); }), "k = 0 is too small; ask for at least 1 neighbour");
    queries[3 * 7] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal([&] { index.nearest(queries, 2); }), "queries[7] is not finite; leave such points out first");
    EXPECT_EQ(refusal([&] { NeighborIndex{Points(queries)}; }), "points[7] is not finite; leave such points out first");
    EXPECT_EQ(refusal([&] { index.nearest(Points(queries.data(), std::size_t(1) << 31), 2); }),
              "queries has 2147483648 entries, more than 2147483647; split them");
}

#ifdef __x86_64__
TEST(NearestKernels, SameFromEveryInstructionSet) {
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this machine has no AVX2";
    std::vector<double> repeated = random_points(700, 11);
    for (int copy = 0; copy < 3; ++copy) repeated.insert(repeated.end(), repeated.begin(), repeated.begin() + 2100);
    for (const std::vector<double>& points : {support::torus_cloud(1, 0.4, 0.04, 12).points, repeated})
        for (const int k : {1, 5, 20, 50, 333})
            EXPECT_EQ(nearest_neighbors(points, k, nearest_kernel_baseline, {}).index,
                      nearest_neighbors(points, k, nearest_kernel_avx2, {}).index)
                << k;
}
#endif
