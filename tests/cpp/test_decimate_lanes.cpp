// The arithmetic of collapses compiled for each instruction set: the same bits from all, and what plain formulas say.
#include <array>
#include <random>

#include "../../src/collapse_lanes.h"
#include "support.h"

using namespace gaussmap;

namespace {

/// A vertex, those around it, and faces from it to pairs of them, nothing regular about them.
struct Case {
    std::vector<Vec3> position;
    std::vector<Symmetric> shape;
    std::vector<QuadricRest> rest;
    std::vector<RingMesh::Sector> sectors;
    std::vector<std::int32_t> others;

    VertexQuadrics quadrics(bool with_rest) const {
        return {position.data(), shape.data(), with_rest ? rest.data() : nullptr};
    }
};

Case random_case(std::size_t n, std::uint32_t seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto vector = [&] { return Vec3{any(rng), any(rng), any(rng)}; };
    Case made;
    for (std::size_t v = 0; v < n; ++v) {
        made.position.push_back(vector());
        Symmetric s;
        for (int k = 0; k < 3; ++k) s.add_normal(vector(), 0.5 + 0.5 * any(rng));
        made.shape.push_back(s);
        made.rest.push_back({vector(), 3 + any(rng)});
    }
    for (std::int32_t v = 1; v < static_cast<std::int32_t>(n); ++v) {
        made.others.push_back(v);
        made.sectors.push_back({3 * v, v, 1 + v % static_cast<std::int32_t>(n - 1)});
    }
    return made;
}

/// min over x of xᵀ(A + e I)x − 2 g·x + c by Cramer's rule on the sum of two quadrics, each evaluated about its own
/// vertex.
double expected_cost(const Case& c, std::int32_t v, std::int32_t w, bool with_rest) {
    const Vec3 middle = 0.5 * (c.position[v] + c.position[w]);
    Symmetric a;
    Vec3 g;
    double constant = 0;
    for (const std::int32_t u : {v, w}) {
        const Vec3 from = middle - c.position[u];  // a quadric's own origin is its vertex
        const Vec3 b = with_rest ? c.rest[u].b : Vec3{};
        a += c.shape[u];
        g = g + b - c.shape[u].times(from);
        constant += dot(from, c.shape[u].times(from)) - 2 * dot(b, from) + (with_rest ? c.rest[u].c : 0);
    }
    const double e = collapse_pull * a.trace();
    const Vec3 rows[] = {{a.xx + e, a.xy, a.xz}, {a.xy, a.yy + e, a.yz}, {a.xz, a.yz, a.zz + e}};
    const double det = dot(rows[0], cross(rows[1], rows[2]));
    const Vec3 x =
        1 / det * (g.x * cross(rows[1], rows[2]) + g.y * cross(rows[2], rows[0]) + g.z * cross(rows[0], rows[1]));
    const double least = constant - dot(g, x);
    return std::max(0.0, least) + flat_cost * a.trace() * squared(c.position[w] - c.position[v]);
}

}  // namespace

TEST(CollapseLanes, CostsAreTheLeastOfTheSummedQuadrics) {
    const Case c = random_case(12, 5);
    for (const bool with_rest : {false, true}) {
        std::vector<double> cost(c.others.size());
        collapse_lanes().costs(c.quadrics(with_rest), 0, c.others.data(), c.others.size(), cost.data());
        for (std::size_t i = 0; i < cost.size(); ++i) {
            const double expected = expected_cost(c, 0, c.others[i], with_rest);
            EXPECT_NEAR(cost[i], expected, 1e-11 * (1 + expected)) << i;
        }
    }
}

TEST(CollapseLanes, FlatQuadricsCostNoMoreThanTheirLength) {
    Case c = random_case(3, 6);
    for (Vec3& p : c.position) p.z = 0;
    for (Symmetric& s : c.shape) s = {}, s.add_normal({0, 0, 1}, 2);
    std::vector<double> cost(2);
    collapse_lanes().costs(c.quadrics(false), 0, c.others.data(), 2, cost.data());
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(cost[i], flat_cost * 4 * squared(c.position[c.others[i]] - c.position[0]), 1e-20);
    c.shape.assign(3, Symmetric{});
    collapse_lanes().costs(c.quadrics(false), 0, c.others.data(), 2, cost.data());
    EXPECT_EQ(cost, std::vector<double>(2, 0.0));
}

TEST(CollapseLanes, WhateverTurnsOverIsSuspect) {
    std::size_t suspects = 0, turned = 0;
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
        const Case c = random_case(2 + seed % 7, seed);
        const Vec3 at = c.position[0], p = at + (seed % 2 ? 0.05 : 0.6) * c.rest[0].b;
        bool turns = false;
        for (const RingMesh::Sector& s : c.sectors) {
            const Vec3 from = c.position[s.from], to = c.position[s.to];
            turns = turns || turns_over(at, from, to, p, from, to);
        }
        const bool suspect = collapse_lanes().may_spoil(c.position.data(), c.sectors.data(), c.sectors.size(), at, p);
        EXPECT_TRUE(suspect || !turns) << seed;
        suspects += suspect, turned += turns;
    }
    EXPECT_GT(turned, 50u);
    EXPECT_LT(suspects, 350u);
    // What is not a number is suspect too.
    const Case c = random_case(4, 1);
    const Vec3 nowhere{std::nan(""), 0, 0};
    EXPECT_TRUE(collapse_lanes().may_spoil(c.position.data(), c.sectors.data(), 3, c.position[0], nowhere));
    EXPECT_FALSE(collapse_lanes().may_spoil(c.position.data(), c.sectors.data(), 0, c.position[0], nowhere));
}

TEST(CollapseLanes, PlanesOfFaces) {
    for (std::size_t n : {2, 3, 4, 5, 6, 9}) {
        const Case c = random_case(n, static_cast<std::uint32_t>(n));
        Symmetric expected;
        std::vector<std::int32_t> corners;
        for (const RingMesh::Sector& s : c.sectors) {
            const Vec3 normal = cross(c.position[s.from] - c.position[0], c.position[s.to] - c.position[0]);
            if (s.from != s.to) expected.add_normal(normal, 0.5 / length(normal));
            corners.insert(corners.end(), {0, s.from, s.to});
        }
        const Symmetric sum =
            collapse_lanes().planes(c.position.data(), c.sectors.data(), c.sectors.size(), c.position[0]);
        EXPECT_NEAR(sum.xx, expected.xx, 1e-14);
        EXPECT_NEAR(sum.xy, expected.xy, 1e-14);
        EXPECT_NEAR(sum.xz, expected.xz, 1e-14);
        EXPECT_NEAR(sum.yy, expected.yy, 1e-14);
        EXPECT_NEAR(sum.yz, expected.yz, 1e-14);
        EXPECT_NEAR(sum.zz, expected.zz, 1e-14);

        std::vector<double> planes(18 * c.sectors.size());
        collapse_lanes().face_planes(c.position.data(), corners.data(), c.sectors.size(), planes.data());
        std::array<double, 6> added{};
        for (std::size_t i = 0; i < planes.size(); ++i) added[i % 6] += planes[i] / 3;
        const std::array<double, 6> wanted{expected.xx, expected.xy, expected.xz,
                                           expected.yy, expected.yz, expected.zz};
        for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(added[k], wanted[k], 1e-14) << n << ' ' << k;
    }
}

#ifdef __x86_64__
TEST(CollapseLanes, SameBitsFromEveryInstructionSet) {
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this machine has no AVX2";
    const CollapseLanes *one = &collapse_lanes_baseline, *other = &collapse_lanes_avx2;
    for (std::size_t n = 2; n < 14; ++n) {
        const Case c = random_case(n, static_cast<std::uint32_t>(100 + n));
        const std::size_t count = n - 1;
        const auto costs = [&](const CollapseLanes& lanes, bool with_rest) {
            std::vector<double> cost(count);
            lanes.costs(c.quadrics(with_rest), 0, c.others.data(), count, cost.data());
            return cost;
        };
        for (const bool with_rest : {false, true})
            EXPECT_TRUE(support::same_bits(costs(*one, with_rest), costs(*other, with_rest))) << n;
        std::vector<std::int32_t> corners;
        for (const RingMesh::Sector& s : c.sectors) corners.insert(corners.end(), {0, s.from, s.to});
        const auto planes = [&](const CollapseLanes& lanes) {
            const Symmetric s = lanes.planes(c.position.data(), c.sectors.data(), count, c.position[0]);
            std::vector<double> all{s.xx, s.xy, s.xz, s.yy, s.yz, s.zz};
            std::vector<double> faces(18 * count);
            lanes.face_planes(c.position.data(), corners.data(), count, faces.data());
            all.insert(all.end(), faces.begin(), faces.end());
            return all;
        };
        EXPECT_TRUE(support::same_bits(planes(*one), planes(*other))) << n;
        for (double step : {1e-3, 0.1, 1.0}) {
            const Vec3 at = c.position[0], p = at + step * c.rest[0].b;
            EXPECT_EQ(one->may_spoil(c.position.data(), c.sectors.data(), count, at, p),
                      other->may_spoil(c.position.data(), c.sectors.data(), count, at, p));
        }
    }
}
#endif
