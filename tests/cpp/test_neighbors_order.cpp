// The spatial order of clouds.
#include <algorithm>
#include <limits>
#include <numeric>

#include "clouds.h"
#include "gaussmap/neighbors.h"

using namespace gaussmap;
using support::Random;
using support::refusal;

namespace {

double mean_step(const std::vector<double>& points, const std::vector<std::int32_t>& order) {
    double sum = 0;
    for (std::size_t j = 1; j < order.size(); ++j) {
        const double *p = &points[3 * static_cast<std::size_t>(order[j - 1])],
                     *q = &points[3 * static_cast<std::size_t>(order[j])];
        sum += std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    }
    return sum / static_cast<double>(order.size() - 1);
}

void expect_permutation(const std::vector<std::int32_t>& order, std::size_t count, const char* what) {
    std::vector<std::int32_t> sorted = order, all(count);
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(sorted, all) << what;
}

/// The points of a cloud in a random order.
std::vector<double> shuffled(const std::vector<double>& points, std::uint64_t seed) {
    Random random(seed);
    std::vector<double> result = points;
    for (std::size_t i = result.size() / 3; i > 1; --i)
        std::swap_ranges(&result[3 * (i - 1)], &result[3 * (i - 1)] + 3, &result[3 * random.below(i)]);
    return result;
}

std::vector<double> ordered(const std::vector<double>& points) {
    std::vector<double> result;
    for (const std::int32_t i : spatial_order(points))
        result.insert(result.end(), &points[3 * static_cast<std::size_t>(i)],
                      &points[3 * static_cast<std::size_t>(i)] + 3);
    return result;
}

}  // namespace

TEST(SpatialOrder, NearPointsFollowEachOther) {
    const double step = 0.01;
    const std::vector<double> torus = shuffled(support::torus_cloud(1, 0.5, step, 1).points, 2);
    const std::vector<std::int32_t> order = spatial_order(torus);
    expect_permutation(order, torus.size() / 3, "torus");
    EXPECT_LT(mean_step(torus, order), 2.5 * step);
}

/// Cells of the whole box would hold either cluster entirely.
TEST(SpatialOrder, FarClustersAreResolved) {
    const double step = 0.02;
    const std::vector<double> torus = shuffled(support::torus_cloud(1, 0.5, step, 3).points, 4);
    std::vector<double> clusters = torus;
    for (std::size_t i = 0; i < torus.size(); ++i) clusters.push_back(torus[i] + (i % 3 == 0 ? 1e7 : 0));
    const std::vector<std::int32_t> order = spatial_order(clusters);
    expect_permutation(order, clusters.size() / 3, "clusters");
    const double jump = 1e7 / static_cast<double>(order.size() - 1);
    EXPECT_LT(mean_step(clusters, order) - jump, 2.5 * step);
}

TEST(SpatialOrder, DependsOnPositionsAlone) {
    const std::vector<double> torus = support::torus_cloud(1, 0.5, 0.02, 5).points;
    EXPECT_EQ(ordered(torus), ordered(shuffled(torus, 6)));
    std::vector<double> repeated = torus;
    for (int copy = 0; copy < 3; ++copy) repeated.insert(repeated.end(), torus.begin(), torus.end());
    EXPECT_EQ(ordered(repeated), ordered(shuffled(repeated, 7)));
}

TEST(SpatialOrder, EqualPositionsByIndex) {
    std::vector<double> points(3 * 100000, 0.25);
    std::vector<std::int32_t> all(100000);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(spatial_order(points), all);
    for (std::size_t i = 0; i < 100000; ++i)
        points[3 * i + 1] = static_cast<double>(i % 50), points[3 * i + 2] = i % 3 ? 0.0 : -0.0;
    const std::vector<std::int32_t> order = spatial_order(points);
    for (std::size_t j = 1; j < order.size(); ++j)
        if (order[j - 1] % 50 == order[j] % 50) { ASSERT_EQ(order[j], order[j - 1] + 50); }
}

TEST(SpatialOrder, AnyMagnitude) {
    const std::vector<double> torus = support::torus_cloud(1, 0.5, 0.05, 8).points;
    for (const double scale : {1e308, 1e300, 1e-200, 1e-307, 1e-321, 5e-324}) {
        std::vector<double> points = torus;
        for (double& v : points) v *= scale;
        expect_permutation(spatial_order(points), points.size() / 3, "scaled");
        EXPECT_EQ(ordered(points), ordered(shuffled(points, 9))) << scale;
    }
    std::vector<double> spiral;
    for (int i = -1000; i < 1000; ++i)
        spiral.insert(spiral.end(), {std::ldexp(1, i), -std::ldexp(1, i), std::ldexp(1, -i)});
    expect_permutation(spatial_order(spiral), 2000, "powers of two");
    EXPECT_EQ(ordered(spiral), ordered(shuffled(spiral, 10)));
}

TEST(SpatialOrder, SameForAnyNumberOfThreads) {
    const std::vector<double> torus = shuffled(support::torus_cloud(1, 0.5, 0.01, 11).points, 12);
    std::vector<double> line = torus;
    for (std::size_t i = 0; i < line.size(); i += 3) line[i + 1] = line[i + 2] = line[i];
    for (const std::vector<double>& points : {torus, line}) {
        const std::vector<std::int32_t> one = spatial_order(points, {1, {}});
        EXPECT_EQ(one, spatial_order(points, {2, {}}));
        EXPECT_EQ(one, spatial_order(points, {7, {}}));
    }
}

TEST(SpatialOrder, FewPointsAndRefusals) {
    EXPECT_TRUE(spatial_order(Points()).empty());
    std::vector<double> points = {1, 2, 3};
    EXPECT_EQ(spatial_order(points), std::vector<std::int32_t>{0});
    points.insert(points.end(), {0, std::numeric_limits<double>::infinity(), 0});
    EXPECT_EQ(refusal([&] { spatial_order(points); }), "points[1] is not finite; leave such points out first");
    EXPECT_EQ(refusal([&] { spatial_order(Points(points.data(), std::size_t(1) << 31)); }),
              "points has 2147483648 entries, more than 2147483647; split the cloud");
}

TEST(SpatialOrder, ReportsProgressAndCanBeCancelled) {
    const std::vector<double> points = support::torus_cloud(1, 0.5, 0.01, 13).points;
    double last = 0;
    spatial_order(points, {1, [&](double done) {
                               EXPECT_GE(done, last);
                               last = done;
                               return true;
                           }});
    EXPECT_DOUBLE_EQ(last, 1);
    EXPECT_THROW(spatial_order(points, {1, [](double done) { return done < 0.5; }}), Cancelled);
}
