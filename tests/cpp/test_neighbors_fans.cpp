// Fans against the definition of the Delaunay triangulation: empty circumcircles.
#include <algorithm>
#include <limits>

#include "clouds.h"
#include "neighborhoods.h"

using namespace gaussmap;
using support::chain_of;
using support::Neighborhoods;
using support::Plane;
using support::Random;
using support::refusal;
using support::triangles_of;

namespace {

double cross(Plane a, Plane b) {
    return a[0] * b[1] - a[1] * b[0];
}
double squared(Plane a) {
    return a[0] * a[0] + a[1] * a[1];
}

/// Positive where c lies outside the circle through 0, a and b (counterclockwise). Exact for small integers.
double outside(Plane a, Plane b, Plane c) {
    return squared(c) * cross(a, b) - squared(b) * cross(a, c) - squared(a) * cross(c, b);
}

std::set<std::pair<int, int>> delaunay_triangles(const std::vector<Plane>& q) {
    std::set<std::pair<int, int>> triangles;
    const int n = static_cast<int>(q.size());
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            if (cross(q[a], q[b]) <= 0) continue;
            bool empty = true;
            for (int c = 0; c < n && empty; ++c) empty = c == a || c == b || outside(q[a], q[b], q[c]) > 0;
            if (empty) triangles.emplace(a, b);
        }
    return triangles;
}

double fan_area(const std::vector<Plane>& q, const std::vector<int>& chain, bool closed) {
    double area = 0;
    for (const auto& [a, b] : triangles_of(chain, closed)) area += cross(q[a], q[b]) / 2;
    return area;
}

}  // namespace

TEST(Fans, OutsideIsTheEmptyCircleTest) {
    EXPECT_GT(outside({1, 0}, {0, 1}, {2, 2}), 0);
    EXPECT_LT(outside({1, 0}, {0, 1}, {0.5, 0.5}), 0);
    EXPECT_EQ(outside({1, 0}, {0, 1}, {1, 1}), 0);
    EXPECT_GT(outside({1, 0}, {0, 1}, {-0.1, -0.1}), 0);
}

TEST(Fans, RandomNeighborhoodsAsTheDefinition) {
    Random random(1);
    const std::size_t k = 18, count = 10000;
    Neighborhoods many(k);
    std::vector<std::vector<Plane>> planes;
    for (std::size_t i = 0; i < count; ++i) {
        const std::vector<double> turn = support::random_rotation(random);  // its columns are the frame
        std::vector<std::array<double, 3>> offsets;
        std::vector<Plane> plane;
        for (std::size_t j = 0; j < k; ++j) {
            const double angle = (i % 4 == 0 ? 0.5 : 1) * 2 * std::numbers::pi * random.uniform();
            const double radius = i % 3 == 0 ? std::exp(-6 * random.uniform()) : std::sqrt(random.uniform());
            const Plane q = {radius * std::cos(angle), radius * std::sin(angle)};
            const std::vector<double> d = support::times(turn, {q[0], q[1], 0.3 * random.normal()});
            plane.push_back(q);
            offsets.push_back({d[0], d[1], d[2]});
        }
        many.add(offsets, {0, 0, 0}, {7 * turn[2], 7 * turn[5], 7 * turn[8]});
        planes.push_back(plane);
    }
    const Fans fans = many.fans();
    std::size_t closed = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t centre = i * (k + 1);
        closed += fans.closed[centre];
        ASSERT_EQ(triangles_of(chain_of(fans, centre), fans.closed[centre]), delaunay_triangles(planes[i])) << i;
    }
    EXPECT_GT(closed, count / 2);
    EXPECT_LT(closed, count * 3 / 4 + 1);
}

/// Lattice points make collinear, cocircular and repeated neighbours, and their determinants are exact.
TEST(Fans, LatticeNeighborhoodsAreDelaunayAndComplete) {
    Random random(2);
    const std::size_t k = 16, count = 4000;
    Neighborhoods many(k);
    std::vector<std::vector<Plane>> planes;
    for (std::size_t i = 0; i < count; ++i) {
        const double low = i % 5 == 0 ? 0 : -3;
        std::vector<std::array<double, 3>> offsets;
        std::vector<Plane> plane;
        for (std::size_t j = 0; j < k; ++j) {
            plane.push_back({low + double(random.below(7)), -3 + double(random.below(7))});
            offsets.push_back({plane.back()[0], plane.back()[1], double(random.below(3))});
        }
        many.add(offsets);
        planes.push_back(plane);
    }
    const Fans fans = many.fans();
    for (std::size_t i = 0; i < count; ++i) {
        const std::vector<Plane>& q = planes[i];
        const std::vector<int> chain = chain_of(fans, i * (k + 1));
        const auto triangles = triangles_of(chain, fans.closed[i * (k + 1)]);
        double turned = 0;
        for (const auto& [a, b] : triangles) {
            ASSERT_GT(cross(q[a], q[b]), 0) << i;
            turned += std::atan2(cross(q[a], q[b]), q[a][0] * q[b][0] + q[a][1] * q[b][1]);
            for (std::size_t c = 0; c < k; ++c) {
                const bool between = cross(q[a], q[c]) > 0 && cross(q[c], q[b]) > 0;
                if (squared(q[c]) == 0) continue;
                ASSERT_GE(outside(q[a], q[b], q[c]), 0) << i << ": a circle that is not empty";
                ASSERT_FALSE(between && outside(q[a], q[b], q[c]) == 0) << i << ": a cocircular neighbour left out";
            }
        }
        // What the fan does not turn through holds no neighbour; only neighbours on one line make no fan.
        if (fans.closed[i * (k + 1)]) {
            ASSERT_NEAR(turned, 2 * std::numbers::pi, 1e-9) << i;
        } else if (!chain.empty()) {
            for (const Plane& c : q) ASSERT_FALSE(cross(q[chain.back()], c) > 0 && cross(c, q[chain.front()]) > 0) << i;
        }
        bool line = true;
        for (const Plane& a : q)
            for (const Plane& b : q) line = line && cross(a, b) == 0;
        ASSERT_EQ(chain.empty(), line) << i;
    }
}

TEST(Fans, SquareCellsCountInFull) {
    std::vector<std::array<double, 3>> offsets;
    std::vector<Plane> plane;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
            if (x != 0 || y != 0) offsets.push_back({double(x), double(y), 0}), plane.push_back({double(x), double(y)});
    // Turned by angles at which nothing is representable, too.
    for (const double angle : {0.0, 0.1, 1.0, 2.5}) {
        Neighborhoods one(24);
        std::vector<std::array<double, 3>> turned;
        for (const auto& d : offsets)
            turned.push_back(
                {std::cos(angle) * d[0] - std::sin(angle) * d[1], std::sin(angle) * d[0] + std::cos(angle) * d[1], 0});
        one.add(turned);
        const Fans fans = one.fans();
        EXPECT_EQ(fans.closed[0], 1);
        EXPECT_EQ(chain_of(fans, 0).size(), 8u) << angle;
        EXPECT_NEAR(fan_area(plane, chain_of(fans, 0), true), 4, 1e-12) << angle;
    }
}

TEST(Fans, OpenFans) {
    Neighborhoods some(8);
    some.add({{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}});  // on a straight border
    some.add({{1, 0, 0}, {0, 1, 0}});                                     // a corner of one triangle
    some.add({{0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 2, 0}});               // a corner, a ray met twice
    some.add({{1, 1, 0}, {2, 0, 0}, {1, -1, 0}});                         // cocircular with the centre
    const Fans fans = some.fans();
    EXPECT_EQ(fans.closed, std::vector<std::uint8_t>(fans.closed.size(), 0));
    EXPECT_EQ(chain_of(fans, 0), (std::vector<int>{0, 1, 2, 3, 4}));
    EXPECT_EQ(chain_of(fans, 6), (std::vector<int>{0, 1}));
    EXPECT_EQ(chain_of(fans, 9), (std::vector<int>{1, 2, 0}));
    EXPECT_EQ(chain_of(fans, 14), (std::vector<int>{2, 1, 0}));
}

TEST(Fans, NeighborsThatMakeNoFan) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::array<double, 3>> ring = {{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};
    Neighborhoods some(4);
    some.add({{1, 2, 0}, {2, 4, 0}, {-1, -2, 0}, {-3, -6, 1}});  // all on a line
    some.add({{1, 2, 0}, {2, 4, 0}});                            // all on a ray
    some.add({{0, 0, 1}, {0, 0, 2}, {0, 0, -1}});                // above and below
    some.add({{0, 0, 0}, {0, 0, 0}});                            // copies of the centre
    some.add({{1, 0, 0}});
    some.add({});
    some.add(ring, {0, 0, 0}, {0, 0, 0});
    some.add(ring, {0, 0, 0}, {0, nan, 1});
    some.add({{1e308, 0, 0}, {0, 1, 0}, {-1, -1, 0}}, {-1e308, 0, 0});  // a difference overflows
    const Fans fans = some.fans();
    EXPECT_TRUE(fans.index.empty());
    EXPECT_EQ(fans.begin, std::vector<std::uint64_t>(some.points.size() / 3 + 1, 0));
    EXPECT_EQ(fans.closed, std::vector<std::uint8_t>(some.points.size() / 3, 0));
}

TEST(Fans, PassesOverWhatIsAboveBehindOrRepeated) {
    Neighborhoods some(6);
    some.add({{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}, {0, 0, 0.5}, {1e-14, 0, 0.1}});
    some.add({{2, 0, 0}, {0, 1, 0}, {-1, -1, 0}, {1, 0, 5}, {0, 1, 3}, {-1, -1, 9}});
    const Fans fans = some.fans();
    EXPECT_EQ(triangles_of(chain_of(fans, 0), true), (std::set<std::pair<int, int>>{{0, 1}, {1, 2}, {2, 0}}));
    EXPECT_EQ(triangles_of(chain_of(fans, 6), true), (std::set<std::pair<int, int>>{{3, 1}, {1, 2}, {2, 3}}));
}

TEST(Fans, OrderScaleAndFlipOfTheNeighborhood) {
    Random random(3);
    const std::size_t k = 20;
    std::vector<std::array<double, 3>> offsets;
    for (std::size_t j = 0; j < k; ++j)
        offsets.push_back({std::floor(7 * random.normal()), std::floor(7 * random.normal()), random.normal()});
    for (int trial = 0; trial < 50; ++trial) {
        Neighborhoods plain(k), tiny(k), flipped(k);
        plain.add(offsets);
        flipped.add(offsets, {0, 0, 0}, {0, 0, -1});
        std::vector<std::array<double, 3>> small = offsets;
        for (auto& d : small)
            for (double& v : d) v = std::ldexp(v, -900);
        tiny.add(small);
        Neighborhoods shuffled = plain;
        for (std::size_t j = 0; j < k; ++j)
            std::swap(shuffled.neighbors.index[j], shuffled.neighbors.index[random.below(k)]);
        const Fans fans = plain.fans();
        EXPECT_EQ(shuffled.fans().index, fans.index);
        EXPECT_EQ(tiny.fans().index, fans.index);
        auto reversed = triangles_of(chain_of(flipped.fans(), 0), fans.closed[0]);
        std::set<std::pair<int, int>> turned;
        for (const auto& [a, b] : reversed) turned.emplace(b, a);
        EXPECT_EQ(turned, triangles_of(chain_of(fans, 0), fans.closed[0]));
        for (auto& d : offsets) d[0] += std::floor(3 * random.normal());
    }
}

/// Nearest first, twelve neighbours mostly tell the fan; farthest first they never do.
TEST(Fans, NearestFirstOrFarthestFirst) {
    Random random(4);
    const std::size_t k = 20, count = 6000;
    Neighborhoods nearest(k);
    for (std::size_t trial = 0; trial < count; ++trial) {
        const bool lattice = trial % 3 == 0, thin = trial % 3 == 1;
        const double tilt = random.below(2) == 0 ? 0 : 2 * random.uniform();
        std::vector<std::array<double, 3>> offsets;
        for (std::size_t j = 0; j < k; ++j) {
            double x = 3 * random.normal(), y = random.normal() * (thin ? 1e-3 : 3);
            if (lattice) x = std::round(x), y = std::round(y);
            offsets.push_back({x, y, tilt * x + 0.1 * random.normal()});
        }
        std::sort(offsets.begin(), offsets.end(), [](const auto& a, const auto& b) {
            return std::hypot(a[0], a[1], a[2]) < std::hypot(b[0], b[1], b[2]);
        });
        nearest.add(offsets);
    }
    Neighborhoods farthest = nearest;
    for (auto row = farthest.neighbors.index.begin(); row != farthest.neighbors.index.end(); row += k)
        std::reverse(row, row + k);
    const Fans fans = nearest.fans(), others = farthest.fans();
    EXPECT_EQ(fans.begin, others.begin);
    EXPECT_EQ(fans.index, others.index);
    EXPECT_EQ(fans.closed, others.closed);
}

TEST(Fans, SameForAnyNumberOfThreads) {
    const support::Cloud cloud = support::torus_cloud(1, 0.5, 0.05, 4);
    const Neighbors neighbors = nearest_neighbors(cloud.points, 20);
    const Fans one = fans(cloud.points, cloud.normals, neighbors, {1, {}});
    for (const int threads : {2, 7}) {
        const Fans more = fans(cloud.points, cloud.normals, neighbors, {threads, {}});
        EXPECT_EQ(one.index, more.index);
        EXPECT_EQ(one.begin, more.begin);
        EXPECT_EQ(one.closed, more.closed);
    }
    EXPECT_EQ(std::count(one.closed.begin(), one.closed.end(), 1), static_cast<std::ptrdiff_t>(cloud.count()));
}

TEST(Fans, RefusesArraysThatDoNotMatch) {
    const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0}, two = {0, 0, 1, 0, 0, 1};
    Neighbors neighbors = nearest_neighbors(points, 2);
    EXPECT_EQ(refusal([&] { fans(points, two, neighbors); }), "normals has 2 entries, but there are 3 points");
    EXPECT_EQ(refusal([&] { fans(two, two, neighbors); }),
              "neighbors has 6 entries, but there are 2 points with 2 each");
    neighbors.index[3] = 3;
    EXPECT_EQ(refusal([&] { fans(points, points, neighbors); }), "neighbors[1][1] = 3 is outside [-1, 3)");
    neighbors.index[3] = -2;
    EXPECT_EQ(refusal([&] { fans(points, points, neighbors); }), "neighbors[1][1] = -2 is outside [-1, 3)");
}
