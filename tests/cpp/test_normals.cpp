// Normals of clouds and their orientation. Those of meshes are tested in test_normals_mesh.cpp.
#include "gaussmap/normals.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>

#include "clouds.h"

using namespace gaussmap;
using support::Cloud;
using support::dot3;
using support::Random;
using support::refusal;

namespace {

CloudNormalsResult fit(const Cloud& cloud, CloudNormals method, int degree, int k = 20) {
    return cloud_normals(cloud.points, nearest_neighbors(cloud.points, k), {method, degree, {}});
}

/// Root mean square of the sine between the lines of two sets of normals.
double angle_error(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); i += 3) {
        const double c[3] = {a[i + 1] * b[i + 2] - a[i + 2] * b[i + 1], a[i + 2] * b[i] - a[i] * b[i + 2],
                             a[i] * b[i + 1] - a[i + 1] * b[i]};
        sum += dot3(c, c);
    }
    return std::sqrt(3 * sum / static_cast<double>(a.size()));
}

void flip_at_random(std::vector<double>& normals, Random& random) {
    for (std::size_t i = 0; i < normals.size(); i += 3)
        if (random.below(2) == 0)
            for (std::size_t c = 0; c < 3; ++c) normals[i + c] = -normals[i + c];
}

/// Prim's tree over the symmetrised graph, from the highest point; the definition, in quadratic time.
std::vector<double> oriented_slowly(const std::vector<double>& points, const Neighbors& neighbors,
                                    std::vector<double> normals) {
    const int n = static_cast<int>(neighbors.count());
    std::set<std::pair<int, int>> edges;
    for (int i = 0; i < n; ++i)
        for (std::size_t j = 0; j < neighbors.k && neighbors[i][j] >= 0; ++j)
            edges.emplace(std::min(i, neighbors[i][j]), std::max(i, neighbors[i][j]));
    std::vector<bool> seen(n, false);
    for (;;) {
        std::tuple<double, int, int> best = {std::numeric_limits<double>::infinity(), 0, 0};
        for (const auto& [a, b] : edges)
            if (seen[a] != seen[b]) best = std::min(best, {1 - std::abs(dot3(&normals[3 * a], &normals[3 * b])), a, b});
        auto [weight, from, to] = best;
        if (from == to) {
            int top = -1;
            for (int i = 0; i < n; ++i)
                if (!seen[i] && (top < 0 || points[3 * i + 2] > points[3 * top + 2])) top = i;
            if (top < 0) return normals;
            seen[top] = true;
            if (normals[3 * top + 2] < 0)
                for (int c = 0; c < 3; ++c) normals[3 * top + c] = -normals[3 * top + c];
            continue;
        }
        if (seen[to]) std::swap(from, to);
        seen[to] = true;
        if (dot3(&normals[3 * from], &normals[3 * to]) < 0)
            for (int c = 0; c < 3; ++c) normals[3 * to + c] = -normals[3 * to + c];
    }
}

}  // namespace

TEST(CloudNormals, UnitAndUpward) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.1, 1);
    for (const CloudNormals method : {CloudNormals::pca, CloudNormals::weighted_pca, CloudNormals::jet}) {
        const CloudNormalsResult result = fit(torus, method, 3);
        EXPECT_EQ(result.undefined, 0u);
        EXPECT_EQ(result.lowered, 0u);
        for (std::size_t i = 0; i < torus.count(); ++i) {
            ASSERT_NEAR(dot3(&result.normals[3 * i], &result.normals[3 * i]), 1, 1e-14);
            ASSERT_GE(result.normals[3 * i + 2], 0);
        }
    }
}

/// Slopes of a fit of degree d are right up to terms of degree d.
TEST(CloudNormals, OrdersOfConvergence) {
    const Cloud coarse = support::torus_cloud(1, 0.5, 0.08, 2), fine = support::torus_cloud(1, 0.5, 0.04, 2);
    const double best_possible[] = {0, 1.7, 3, 6, 12};
    for (int degree = 1; degree <= 4; ++degree) {
        const double before = angle_error(fit(coarse, CloudNormals::jet, degree).normals, coarse.normals);
        const double after = angle_error(fit(fine, CloudNormals::jet, degree).normals, fine.normals);
        EXPECT_LT(after, before / best_possible[degree]) << "degree " << degree;
    }
    EXPECT_LT(angle_error(fit(fine, CloudNormals::jet, 4).normals, fine.normals), 3e-5);
    const double plain = angle_error(fit(fine, CloudNormals::pca, 1).normals, fine.normals);
    EXPECT_LT(plain, 0.03);
    EXPECT_LT(angle_error(fit(fine, CloudNormals::weighted_pca, 1).normals, fine.normals), plain / 2);
}

/// Second moments by the definition, weights and all, and the eigenvector by turning the normal until nothing improves.
TEST(CloudNormals, PrincipalDirectionsAsTheDefinition) {
    const Cloud torus = support::ellipsoid_cloud(1, 0.7, 0.05, 300, 15);
    const std::size_t k = 11;
    const Neighbors neighbors = nearest_neighbors(torus.points, k);
    for (const CloudNormals method : {CloudNormals::pca, CloudNormals::weighted_pca}) {
        const std::vector<double> normals = cloud_normals(torus.points, neighbors, {method, 1, {}}).normals;
        for (std::size_t i = 0; i < torus.count(); ++i) {
            std::vector<std::array<double, 4>> members = {{0, 0, 0, 1}};  // difference and weight
            double farthest = 0;
            for (std::size_t j = 0; j < k; ++j) {
                std::array<double, 4> d = {0, 0, 0, 1};
                for (std::size_t c = 0; c < 3; ++c)
                    d[c] = torus.points[3 * static_cast<std::size_t>(neighbors[i][j]) + c] - torus.points[3 * i + c];
                farthest = std::max(farthest, dot3(d.data(), d.data()));
                members.push_back(d);
            }
            double all = 0, mean[3] = {}, moments[3][3] = {};
            for (auto& d : members) {
                const double inside = 1 - dot3(d.data(), d.data()) / farthest * double(k) / double(k + 1);
                if (method == CloudNormals::weighted_pca) d[3] = inside * inside;
                all += d[3];
                for (int c = 0; c < 3; ++c) mean[c] += d[3] * d[c];
            }
            for (const auto& d : members)
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c) moments[r][c] += d[3] * (d[r] - mean[r] / all) * (d[c] - mean[c] / all);
            // An eigenvector, and no direction has less: M − λ is positive but for rounding.
            const double* n = &normals[3 * i];
            double image[3], lambda = 0, trace = 0;
            for (int r = 0; r < 3; ++r)
                image[r] = dot3(moments[r], n), lambda += n[r] * image[r], trace += moments[r][r];
            for (int r = 0; r < 3; ++r) ASSERT_NEAR(image[r], lambda * n[r], 1e-14 * trace) << i;
            for (int r = 0; r < 3; ++r) {
                const int s = (r + 1) % 3;
                ASSERT_GE(moments[r][r] - lambda, -1e-14 * trace) << i;
                ASSERT_GE((moments[r][r] - lambda) * (moments[s][s] - lambda) - moments[r][s] * moments[r][s],
                          -1e-14 * trace * trace)
                    << i;
            }
        }
    }
}

TEST(CloudNormals, PlanesInAnyDirection) {
    Random random(4);
    const Cloud flat = support::lattice_cloud(6, 0);
    for (int trial = 0; trial < 30; ++trial) {
        const std::vector<double> rotation = support::random_rotation(random);
        Cloud plane = flat;
        plane.points = support::times(rotation, flat.points);
        const std::vector<double> expected = support::times(rotation, flat.normals);
        for (const CloudNormals method : {CloudNormals::pca, CloudNormals::weighted_pca, CloudNormals::jet}) {
            const CloudNormalsResult result = fit(plane, method, 2);
            EXPECT_EQ(result.undefined, 0u);
            EXPECT_LT(angle_error(result.normals, expected), 1e-14);
        }
    }
}

TEST(CloudNormals, DegreeIsLoweredWhereTheNeighborsDoNotDetermineIt) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.1, 5);
    EXPECT_EQ(fit(torus, CloudNormals::jet, 4, 20).lowered, 0u);
    for (const auto& [k, degree] : {std::pair{13, 3}, {8, 2}, {4, 1}}) {
        const CloudNormalsResult low = fit(torus, CloudNormals::jet, 4, k);
        EXPECT_EQ(low.lowered, torus.count()) << "too few neighbours for degree 4";
        EXPECT_TRUE(support::same_bits(low.normals, fit(torus, CloudNormals::jet, degree, k).normals));
    }
    EXPECT_EQ(fit(torus, CloudNormals::pca, 4, 4).lowered, 0u) << "nothing to lower";
    // On a lattice of three columns x³ = x: cubics are not determined however many neighbours there are.
    Cloud strip;
    for (int y = 0; y < 12; ++y)
        for (int x = -1; x <= 1; ++x) strip.add({double(x), double(y), 0.05 * x * x}, {0, 0, 1}, 0);
    const CloudNormalsResult result = fit(strip, CloudNormals::jet, 3, 20);
    EXPECT_GT(result.lowered, 10u);
    EXPECT_EQ(result.undefined, 0u);
    for (std::size_t i = 0; i < strip.count(); ++i) {
        const double slope = 0.1 * strip.points[3 * i], size = std::sqrt(1 + slope * slope);
        ASSERT_NEAR(std::abs(result.normals[3 * i + 2]), 1 / size, 2e-3) << i;
    }
}

TEST(CloudNormals, FewNeighbors) {
    const std::vector<double> points = {0, 0, 0, 2, 0, 0, 0, 0, 3, 5, 5, 5};
    Neighbors neighbors;
    neighbors.k = 3;
    neighbors.index = {1, 2, -1, 0, -1, -1, -1, -1, -1, 0, 1, 2};
    for (const CloudNormals method : {CloudNormals::pca, CloudNormals::jet}) {
        const CloudNormalsResult result = cloud_normals(points, neighbors, {method, 2, {}});
        EXPECT_EQ(result.undefined, 2u) << "one neighbour, and none";
        for (int c = 3; c < 9; ++c) EXPECT_TRUE(std::isnan(result.normals[c]));
        EXPECT_NEAR(result.normals[1], 1, 1e-15) << "two neighbours span a plane";
        EXPECT_EQ(result.lowered, method == CloudNormals::jet ? 2u : 0u);
    }
}

TEST(CloudNormals, LinesAndRepeatedPointsAreUndefined) {
    for (const std::array<double, 3> direction : {std::array<double, 3>{1, 0, 0}, {0.1, 0.2, -0.3}, {0, 0, 0}}) {
        Cloud line;
        for (int i = 0; i < 40; ++i)
            line.add({1 + i * direction[0], 2 + i * direction[1], 3 + i * direction[2]}, {0, 0, 1}, 0);
        EXPECT_EQ(fit(line, CloudNormals::pca, 1).undefined, 40u);
        EXPECT_EQ(fit(line, CloudNormals::jet, 4).undefined, 40u);
    }
}

TEST(CloudNormals, RefusesWhatItCannotDo) {
    const Cloud sphere = support::sphere_cloud(1, 30, 6);
    Neighbors neighbors = nearest_neighbors(sphere.points, 5);
    EXPECT_EQ(refusal([&] {
                  cloud_normals(sphere.points, neighbors, {CloudNormals::jet, 5, {}});
              }),
              "degree = 5 is outside 1 to 4");
    const Points fewer(sphere.points.data(), 29);
    EXPECT_EQ(refusal([&] { cloud_normals(fewer, neighbors); }),
              "neighbors has 150 entries, but there are 29 points with 5 each");
    neighbors.index[7] = 30;
    EXPECT_EQ(refusal([&] { cloud_normals(sphere.points, neighbors); }), "neighbors[1][2] = 30 is outside [-1, 30)");
    std::vector<double> normals = sphere.normals;
    EXPECT_EQ(refusal([&] { orient_normals(sphere.points, neighbors, normals); }),
              "neighbors[1][2] = 30 is outside [-1, 30)");
    normals.resize(3 * 29);
    EXPECT_EQ(refusal([&] { orient_normals(sphere.points, neighbors, normals); }),
              "normals has 29 entries, but there are 30 points");
}

TEST(CloudNormals, SameForAnyNumberOfThreads) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.04, 7);
    const Neighbors neighbors = nearest_neighbors(torus.points, 20);
    const CloudNormalsResult one = cloud_normals(torus.points, neighbors, {CloudNormals::jet, 4, {1, {}}});
    for (const int threads : {2, 7})
        EXPECT_TRUE(support::same_bits(
            one.normals, cloud_normals(torus.points, neighbors, {CloudNormals::jet, 4, {threads, {}}}).normals));
}

TEST(OrientNormals, OutwardOnEveryPart) {
    Random random(8);
    Cloud cloud = support::torus_cloud(1, 0.5, 0.06, 9);
    const Cloud sphere = support::sphere_cloud(0.7, 2000, 10);
    for (std::size_t i = 0; i < sphere.count(); ++i)
        cloud.add({sphere.points[3 * i] + 9, sphere.points[3 * i + 1], sphere.points[3 * i + 2]},
                  {sphere.normals[3 * i], sphere.normals[3 * i + 1], sphere.normals[3 * i + 2]}, 0);
    const Neighbors neighbors = nearest_neighbors(cloud.points, 10);
    std::vector<double> normals = cloud.normals;
    flip_at_random(normals, random);
    orient_normals(cloud.points, neighbors, normals);
    EXPECT_TRUE(support::same_bits(normals, cloud.normals));
    orient_normals(cloud.points, neighbors, normals);
    EXPECT_TRUE(support::same_bits(normals, cloud.normals)) << "nothing left to do";
}

/// Directions drawn at random disagree everywhere, so that every edge of the tree shows in the signs.
TEST(OrientNormals, FollowsTheMinimumSpanningTree) {
    Random random(11);
    for (int trial = 0; trial < 10; ++trial) {
        const Cloud cloud = support::sphere_cloud(1, 150, 100 + static_cast<std::uint64_t>(trial));
        const Neighbors neighbors = nearest_neighbors(cloud.points, trial % 2 == 0 ? 2 : 5);
        std::vector<double> normals = support::sphere_cloud(1, 150, 200 + static_cast<std::uint64_t>(trial)).normals;
        const std::vector<double> expected = oriented_slowly(cloud.points, neighbors, normals);
        flip_at_random(normals, random);
        orient_normals(cloud.points, neighbors, normals);
        EXPECT_TRUE(support::same_bits(normals, expected)) << trial;
    }
}

TEST(OrientNormals, UndefinedNormalsStayAndJoinNothing) {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    // A chain whose middle has no normal, and no neighbour beyond: two parts, each from its own highest point.
    const std::vector<double> points = {0, 0, 5, 1, 0, 4, 2, 0, 3, 3, 0, 2, 4, 0, 1};
    Neighbors neighbors;
    neighbors.k = 2;
    neighbors.index = {1, -1, 0, 2, 1, 3, 2, 4, 3, -1};
    std::vector<double> normals = {0, 0, -1, 0, 0, 1, nothing, 0, 0, 0, 0, -1, 0, 0, 1};
    orient_normals(points, neighbors, normals);
    EXPECT_TRUE(std::isnan(normals[6]));
    EXPECT_EQ(normals[7], 0);
    for (const std::size_t i : {0, 1, 3, 4}) EXPECT_EQ(normals[3 * i + 2], 1) << i;
    std::vector<double> none;
    orient_normals(Points(), Neighbors(), none);
    EXPECT_TRUE(none.empty());
}

TEST(OrientNormals, CanBeCancelled) {
    const Cloud torus = support::torus_cloud(1, 0.5, 0.1, 12);
    std::vector<double> normals = torus.normals;
    EXPECT_THROW(
        orient_normals(torus.points, nearest_neighbors(torus.points, 8), normals, {1, [](double) { return false; }}),
        Cancelled);
}
