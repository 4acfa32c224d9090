// Delaunay fans by inversion: one angular sort and one convex hull in the tangent plane.
#include <algorithm>
#include <cmath>

#include "check.h"
#include "check_cloud.h"
#include "fan.h"
#include "frame.h"
#include "gaussmap/neighbors.h"
#include "parallel.h"

namespace gaussmap {
namespace {

constexpr double tolerance = 1e-12;

double cross(const Ray& a, const Ray& b) {
    return a.u * b.v - a.v * b.u;
}
double dot(const Ray& a, const Ray& b) {
    return a.u * b.u + a.v * b.v;
}

/// Whether the sine of the angle between two rays is zero, to the tolerance.
bool aligned(const Ray& a, const Ray& b) {
    const double c = cross(a, b);
    return c * c <= tolerance * tolerance * a.squared * b.squared;
}

bool same_direction(const Ray& a, const Ray& b) {
    return aligned(a, b) && dot(a, b) > 0;
}
bool half_turn(const Ray& a, const Ray& b) {
    return cross(a, b) <= 0 || (aligned(a, b) && dot(a, b) < 0);
}

bool nearer(const Ray& a, const Ray& b) {
    return a.squared < b.squared || (a.squared == b.squared && a.index < b.index);
}

/// Grows with the polar angle, from 0 to 4, without a trigonometric function.
double diamond_angle(double u, double v) {
    const double t = v / (std::abs(u) + std::abs(v));
    const double right = v < 0 ? 4 + t : t;
    return u < 0 ? 2 - t : right;
}

/// Whether the hull of the inverted points turns inwards at b on the way from a to c, and so passes b by. The sign is
/// that of orient(a', b', c') |a|²|b|²|c|², with a' = a/|a|²: the incircle determinant of 0, a, b and c, free of
/// divisions.
bool inward(const Ray& a, const Ray& b, const Ray& c) {
    const double ab = a.u * b.v, ba = a.v * b.u, bc = b.u * c.v, cb = b.v * c.u, ca = c.u * a.v, ac = c.v * a.u;
    const double determinant = c.squared * (ab - ba) + a.squared * (bc - cb) + b.squared * (ca - ac);
    const double size = c.squared * (std::abs(ab) + std::abs(ba)) + a.squared * (std::abs(bc) + std::abs(cb)) +
                        b.squared * (std::abs(ca) + std::abs(ac));
    return determinant < -tolerance * size;
}

void project(const Neighborhood& neighborhood, const Frame& frame, Fan& fan) {
    fan.rays.clear();
    fan.turns.clear();
    double largest = 0;
    for (std::size_t j = 0; j < neighborhood.count; ++j) largest = std::max(largest, squared(neighborhood.offset[j]));
    for (std::size_t j = 0; j < neighborhood.count; ++j) {
        const Vec3 d = neighborhood.offset[j];
        const double u = gaussmap::dot(d, frame.u), v = gaussmap::dot(d, frame.v), s = u * u + v * v;
        if (s <= tolerance * tolerance * largest) continue;
        fan.turns.push_back({diamond_angle(u, v), static_cast<std::int32_t>(fan.rays.size())});
        fan.rays.push_back({u, v, s, static_cast<std::int32_t>(j), neighborhood.index[j]});
    }
}

/// Sort by angle and leave one ray, the nearest, in each direction.
void sort_turns(Fan& fan) {
    std::vector<Fan::Turn>& turns = fan.turns;
    const auto ray = [&](const Fan::Turn& turn) -> const Ray& { return fan.rays[turn.ray]; };
    std::sort(turns.begin(), turns.end(), [&](const Fan::Turn& a, const Fan::Turn& b) {
        return a.angle < b.angle || (a.angle == b.angle && nearer(ray(a), ray(b)));
    });
    std::size_t kept = 0;
    for (const Fan::Turn& turn : turns) {
        if (kept == 0 || !same_direction(ray(turns[kept - 1]), ray(turn)))
            turns[kept++] = turn;
        else if (nearer(ray(turn), ray(turns[kept - 1])))
            turns[kept - 1] = turn;
    }
    if (kept > 1 && same_direction(ray(turns[kept - 1]), ray(turns[0]))) {
        if (nearer(ray(turns[kept - 1]), ray(turns[0]))) turns[0] = turns[kept - 1];
        --kept;
    }
    turns.resize(kept);
}

}  // namespace

void build_fan(const Neighborhood& neighborhood, Vec3 normal, Fan& fan) {
    fan.chain.clear();
    fan.closed = false;
    if (!finite(normal)) return;
    project(neighborhood, frame_about(normal), fan);
    sort_turns(fan);
    const std::size_t count = fan.turns.size();
    if (count < 2) return;
    const auto ray = [&](std::size_t i) -> const Ray& { return fan.rays[fan.turns[i < count ? i : i - count].ray]; };

    // Start where the hull surely has a corner: after a gap of half a turn, else at the nearest (the farthest
    // inverted).
    std::size_t first = 0, gaps = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (half_turn(ray(i), ray(i + 1))) ++gaps, first = (i + 1) % count;
    if (gaps > 1) return;
    fan.closed = gaps == 0;
    if (fan.closed)
        for (std::size_t i = 1; i < count; ++i)
            if (ray(i).squared < ray(first).squared) first = i;

    std::vector<Ray>& chain = fan.chain;
    const auto pass_by = [&](const Ray& next) {
        while (chain.size() > 1 && inward(chain[chain.size() - 2], chain.back(), next)) chain.pop_back();
    };
    for (std::size_t i = first; i < first + count; ++i) {
        pass_by(ray(i));
        chain.push_back(ray(i));
    }
    if (fan.closed) pass_by(ray(first));
}

Fans fans(Points points, Points normals, const Neighbors& neighbors, const Execution& run) {
    check_count("normals", normals.count, points.count, "points");
    check_neighbors(neighbors.index, neighbors.k, points.count);
    constexpr std::size_t grain = 1024;
    Fans result;
    result.begin.assign(points.count + 1, 0);
    result.closed.assign(points.count, 0);
    std::vector<std::vector<std::int32_t>> chains(block_count(points.count, grain));
    for_blocks(points.count, grain, run, [&](std::size_t block, std::size_t i, std::size_t last) {
        Neighborhood neighborhood(neighbors.k);
        Fan fan;
        for (; i < last; ++i) {
            neighborhood.gather(points, i, neighbors[i]);
            build_fan(neighborhood, unit(load(normals[i])), fan);
            for (const Ray& ray : fan.chain) chains[block].push_back(ray.index);
            result.begin[i + 1] = fan.chain.size();
            result.closed[i] = fan.closed;
        }
    });
    for (std::size_t i = 0; i < points.count; ++i) result.begin[i + 1] += result.begin[i];
    result.index.reserve(result.begin.back());
    for (const auto& chain : chains) result.index.insert(result.index.end(), chain.begin(), chain.end());
    return result;
}

}  // namespace gaussmap
