// Fans against exact Delaunay triangulations (CGAL), 100 000 of them, random and degenerate.
#include <gtest/gtest.h>

#ifdef GAUSSMAP_CGAL
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <map>

#include "clouds.h"
#include "neighborhoods.h"

using namespace gaussmap;
using support::chain_of;
using support::Neighborhoods;
using support::Plane;
using support::Random;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;
using Point = Kernel::Point_2;

constexpr std::size_t k = 20, count = support::sanitized ? 1000 : 20000;

Point point(Plane p) {
    return {p[0], p[1]};
}

/// Where the centre stands in the triangulation of it and its neighbours.
struct Star {
    std::vector<Plane> corners;  ///< of its edges, counterclockwise
    bool open = false, flat = false;

    explicit Star(const std::vector<Plane>& plane) {
        Triangulation triangulation;
        const auto centre = triangulation.insert(Point(0, 0));
        for (const Plane& p : plane) triangulation.insert(point(p));
        flat = triangulation.dimension() < 2;
        if (flat) return;
        auto vertex = triangulation.incident_vertices(centre);
        const auto first = vertex;
        do {
            if (triangulation.is_infinite(vertex))
                open = true;
            else
                corners.push_back({vertex->point().x(), vertex->point().y()});
        } while (++vertex != first);
    }
};

/// Everything that CGAL's star has is in the fan, in the same turn; what the fan has beyond is cocircular with its
/// centre and the corners around it, where the triangulation is a matter of choice. Of equal or aligned neighbours one
/// is left, so corners are compared by position.
void expect_star(const std::vector<Plane>& plane, const std::vector<int>& chain, bool closed) {
    const Star star(plane);
    if (star.flat) {
        ASSERT_TRUE(chain.empty());
        return;
    }
    ASSERT_EQ(closed, !star.open);
    std::vector<Plane> corners;
    for (const int slot : chain) corners.push_back(plane[static_cast<std::size_t>(slot)]);
    std::size_t found = 0;
    for (const Plane& corner : star.corners) found += std::count(corners.begin(), corners.end(), corner) == 1 ? 1 : 0;
    ASSERT_EQ(found, star.corners.size());
    const std::size_t size = corners.size();
    for (std::size_t c = 0; c < size; ++c) {
        if (std::count(star.corners.begin(), star.corners.end(), corners[c]) == 1) continue;
        ASSERT_TRUE(closed || (c > 0 && c + 1 < size)) << "the ends of an open fan are never a matter of choice";
        ASSERT_EQ(CGAL::side_of_oriented_circle(Point(0, 0), point(corners[(c + size - 1) % size]), point(corners[c]),
                                                point(corners[(c + 1) % size])),
                  CGAL::ON_ORIENTED_BOUNDARY);
    }
    for (std::size_t c = 0; c + (closed ? 0 : 1) < size; ++c)
        ASSERT_EQ(CGAL::orientation(Point(0, 0), point(corners[c]), point(corners[(c + 1) % size])), CGAL::LEFT_TURN);
}

/// Neighbourhoods whose projections `draw` makes, the heights being anything.
template <class Draw>
void compare(std::uint64_t seed, Draw&& draw) {
    Random random(seed);
    Neighborhoods many(k);
    std::vector<std::vector<Plane>> planes;
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<Plane> plane;
        for (std::size_t j = 0; j < k; ++j) plane.push_back(draw(random, i, j, plane));
        std::vector<std::array<double, 3>> offsets;
        for (const Plane& p : plane) offsets.push_back({p[0], p[1], 0.1 * random.uniform()});
        many.add(offsets);
        planes.push_back(std::move(plane));
    }
    const Fans fans = many.fans();
    for (std::size_t i = 0; i < count; ++i) {
        expect_star(planes[i], chain_of(fans, i * (k + 1)), fans.closed[i * (k + 1)] != 0);
        if (testing::Test::HasFatalFailure()) FAIL() << "neighbourhood " << i;
    }
}

}  // namespace

TEST(FansOfDelaunay, Random) {
    compare(1, [](Random& random, std::size_t i, std::size_t, auto&) {
        const double angle = 2 * std::numbers::pi * random.uniform();
        const double radius = i % 3 == 0 ? std::exp(-8 * random.uniform()) : std::sqrt(random.uniform());
        return Plane{radius * std::cos(angle), radius * std::sin(angle)};
    });
}

TEST(FansOfDelaunay, Boundary) {
    // A half plane, a corner, a thin strip, and the centre on the border itself.
    compare(2, [](Random& random, std::size_t i, std::size_t j, auto&) {
        const double x = 2 * random.uniform() - 1, y = random.uniform();
        if (i % 4 == 0) return Plane{x, y};
        if (i % 4 == 1) return Plane{std::abs(x), y};
        if (i % 4 == 2) return Plane{x, 1e-6 * y};
        return Plane{x, j < 5 ? 0 : y};
    });
}

TEST(FansOfDelaunay, Grids) {
    compare(3, [](Random& random, std::size_t i, std::size_t j, auto&) {
        if (i % 2 == 0) return Plane{double(random.below(7)) - 3, double(random.below(7)) - 3};
        // A whole 5 × 5 grid less a few, the centre somewhere in it.
        const std::size_t cell = (j + random.below(2)) % 25, at = i % 25;
        return Plane{double(cell % 5) - double(at % 5), double(cell / 5) - double(at / 5)};
    });
}

TEST(FansOfDelaunay, Cocircular) {
    // On circles through the centre, and about it: points of integer coordinates with x² + y² = 25 and 65.
    static const std::vector<Plane> ring = {{5, 0},  {4, 3},   {3, 4},   {0, 5},  {-3, 4}, {-4, 3},
                                            {-5, 0}, {-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}};
    static const std::vector<Plane> wide = {{8, 1}, {7, 4}, {4, 7}, {1, 8}, {-1, 8}, {-4, 7}, {-7, 4}, {-8, 1}};
    compare(4, [](Random& random, std::size_t i, std::size_t j, auto&) {
        const Plane p = ring[random.below(ring.size())], q = wide[random.below(wide.size())];
        if (i % 3 == 0) return p;
        if (i % 3 == 1) return j % 2 == 0 ? p : q;
        return Plane{p[0] + 5, p[1]};
    });
}

TEST(FansOfDelaunay, RepeatedAndCollinear) {
    compare(5, [](Random& random, std::size_t i, std::size_t j, const std::vector<Plane>& before) {
        if (j > 0 && random.below(3) == 0) return before[random.below(j)];
        if (j > 0 && random.below(3) == 0) {
            const Plane p = before[random.below(j)];
            const double by = double(random.below(5)) - 2;
            return Plane{by * p[0], by * p[1]};
        }
        if (i % 4 == 0) return Plane{double(random.below(9)) - 4, 0};
        return Plane{double(random.below(64)) - 32, double(random.below(64)) - 32};
    });
}

#else

TEST(FansOfDelaunay, Exact) {
    GTEST_SKIP() << "CGAL is not installed";
}

#endif
