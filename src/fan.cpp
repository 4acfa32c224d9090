// Delaunay fans by inversion: one angular sort and one convex hull in the tangent plane.
#include "fan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "frame.h"

namespace gaussmap {
namespace {

constexpr double tolerance = 1e-12;

/// Sorting keys: the angle, 0 to 4, in 31 bits; the lowest six of them give way to the slot, so that no two are equal.
constexpr double key_scale = 0x1p28;
constexpr std::int32_t after_all = 0x7fffff00;
constexpr std::size_t few = 64;

/// Neighbours, nearest first, that nearly always have all corners among them.
constexpr std::size_t nearest_few = 12;

/// Four integers in a register.
typedef std::int32_t Keys __attribute__((vector_size(16)));
typedef std::int32_t KeysInMemory __attribute__((vector_size(16), aligned(4), may_alias));

/// Project, invert, and find the polar angles, without a trigonometric function; the number of rays that count.
std::size_t project(const Neighborhood& neighborhood, const Frame& frame, std::size_t slots, Fan& fan) {
    TwoMask counted = {};
    for (std::size_t j = 0; j < slots; j += 2) {
        const Two x = load_two(&neighborhood.x[j]), y = load_two(&neighborhood.y[j]), z = load_two(&neighborhood.z[j]);
        const Two u = x * frame.u.x + y * frame.u.y + z * frame.u.z;
        const Two v = x * frame.v.x + y * frame.v.y + z * frame.v.z;
        const Two one = {1, 1}, squared = u * u + v * v, size = absolute(u) + absolute(v);
        const TwoMask counts = squared > tolerance * tolerance;
        // 1/|q|² and 1/(|u| + |v|) by one division.
        const Two both = 1 / select(counts, squared * size, one), inverse = both * size, t = v * (both * squared);
        const Two angle = select(u < 0, 2 - t, select(v < 0, 4 + t, t));
        const Two key = select(counts, angle * key_scale, one * after_all);
        for (std::size_t l = 0; l < 2; ++l) {
            fan.rays[j + l] = {u[l] * inverse[l], v[l] * inverse[l], size[l] * inverse[l],
                               squared[l],        angle[l],          static_cast<std::int32_t>(j + l)};
            fan.keys[j + l] = static_cast<std::int32_t>(key[l]);
        }
        counted -= counts;
    }
    return static_cast<std::size_t>(counted[0] + counted[1]);
}

/// Every key is compared with every other: no branch goes wrong.
void sort_few(std::size_t slots, Fan& fan) {
    for (std::size_t j = 0; j < slots; ++j)
        fan.keys[j] = static_cast<std::int32_t>((static_cast<std::uint32_t>(fan.keys[j]) & ~63u) | j);
    for (std::size_t i = 0; i < slots; i += lanes) {
        const Keys keys = *reinterpret_cast<const KeysInMemory*>(&fan.keys[i]);
        Keys rank = {};
        for (std::size_t j = 0; j < slots; ++j) rank -= fan.keys[j] < keys;
        for (std::size_t l = 0; l < lanes; ++l) fan.turns[static_cast<std::size_t>(rank[l])] = fan.rays[i + l];
    }
}

/// Rays beyond the first `count` are those that do not count.
void sort_many(std::size_t slots, Fan& fan) {
    std::copy_n(fan.rays.begin(), slots, fan.turns.begin());
    std::sort(fan.turns.begin(), fan.turns.begin() + static_cast<std::ptrdiff_t>(slots),
              [&](const Ray& a, const Ray& b) { return fan.keys[a.slot] < fan.keys[b.slot]; });
}

/// How ray b follows ray a, counterclockwise.
enum class Turn { left, none, half };

Turn turn_between(const Ray& a, const Ray& b) {
    const double cross = a.u * b.v - a.v * b.u, zero = tolerance * a.size * b.size;
    if (cross > zero) return Turn::left;
    return cross >= -zero && a.u * b.u + a.v * b.v > 0 ? Turn::none : Turn::half;
}

/// Whether the hull of the inverted points turns inwards at b on the way from a to c, and so passes b by.
bool inward(const Ray& a, const Ray& b, const Ray& c) {
    const double determinant = (b.u - a.u) * (c.v - b.v) - (b.v - a.v) * (c.u - b.u);
    return determinant < -tolerance * (b.size * (a.size + c.size) + a.size * c.size);
}

/// Sort to the last bit and leave one ray, the nearest, in each direction; the number of rays left.
std::size_t straighten(const Neighborhood& neighborhood, Ray* rays, std::size_t count) {
    const auto nearer = [&](const Ray& a, const Ray& b) {
        return a.squared < b.squared ||
               (a.squared == b.squared && neighborhood.index[a.slot] < neighborhood.index[b.slot]);
    };
    std::sort(rays, rays + count,
              [&](const Ray& a, const Ray& b) { return a.angle < b.angle || (a.angle == b.angle && nearer(a, b)); });
    std::size_t kept = 1;
    for (std::size_t i = 1; i < count; ++i) {
        if (turn_between(rays[kept - 1], rays[i]) != Turn::none)
            rays[kept++] = rays[i];
        else if (nearer(rays[i], rays[kept - 1]))
            rays[kept - 1] = rays[i];
    }
    if (kept > 1 && turn_between(rays[kept - 1], rays[0]) == Turn::none) {
        if (nearer(rays[kept - 1], rays[0])) rays[0] = rays[kept - 1];
        --kept;
    }
    return kept;
}

bool all_left(const Ray* rays, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        if (turn_between(rays[i], rays[i + 1 < count ? i + 1 : 0]) != Turn::left) return false;
    return true;
}

/// Of rays one in each direction: gaps of half a turn or more, and the ray after the last such gap.
struct Gaps {
    std::size_t count = 0, after = 0;

    Gaps(const Ray* rays, std::size_t rays_count) {
        for (std::size_t i = 0; i < rays_count; ++i) {
            const std::size_t next = i + 1 < rays_count ? i + 1 : 0;
            if (turn_between(rays[i], rays[next]) == Turn::half) ++count, after = next;
        }
    }
};

std::size_t nearest(const Ray* rays, std::size_t count) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < count; ++i)
        if (rays[i].squared < rays[best].squared) best = i;
    return best;
}

/// The fan of the first `slots` neighbours.
void build_among(const Neighborhood& neighborhood, const Frame& frame, std::size_t slots, Fan& fan) {
    fan.corners = 0;
    fan.closed = false;
    std::size_t count = project(neighborhood, frame, slots, fan);
    if (count < 2) return;
    if (slots <= few)
        sort_few(slots, fan);
    else
        sort_many(slots, fan);
    Ray* const rays = fan.turns.data();

    // Start where the hull surely has a corner: after a gap of half a turn, else at the nearest (the farthest
    // inverted).
    fan.closed = all_left(rays, count);
    std::size_t first = 0;
    if (!fan.closed) {
        count = straighten(neighborhood, rays, count);
        const Gaps gaps(rays, count);
        if (count < 2 || gaps.count > 1) return;
        fan.closed = gaps.count == 0;
        first = gaps.after;
    }
    if (fan.closed) first = nearest(rays, count);

    // The chain so far, as places of its rays.
    std::int32_t* const chain = fan.chain.data();
    std::size_t size = 0;
    const auto pass_by = [&](const Ray& next) {
        while (size > 1 && inward(rays[chain[size - 2]], rays[chain[size - 1]], next)) --size;
    };
    for (std::size_t i = first; i < first + count; ++i) {
        const std::size_t place = i < count ? i : i - count;
        pass_by(rays[place]);
        chain[size++] = static_cast<std::int32_t>(place);
    }
    if (fan.closed) pass_by(rays[first]);
    for (std::size_t c = 0; c < size; ++c) chain[c] = rays[chain[c]].slot;
    fan.corners = size;
}

/// Least squared distance of the projected neighbours from slot `first` on; of those that count.
double nearest_squared(const Neighborhood& neighborhood, const Frame& frame, std::size_t first) {
    const Two far = Two{1, 1} * std::numeric_limits<double>::infinity();
    Two least = far;
    for (std::size_t j = first; j < padded(neighborhood.count); j += 2) {
        const Two x = load_two(&neighborhood.x[j]), y = load_two(&neighborhood.y[j]), z = load_two(&neighborhood.z[j]);
        const Two u = x * frame.u.x + y * frame.u.y + z * frame.u.z;
        const Two v = x * frame.v.x + y * frame.v.y + z * frame.v.z;
        const Two squared = u * u + v * v, counted = select(squared > tolerance * tolerance, squared, far);
        least = select(counted < least, counted, least);
    }
    return std::min(least[0], least[1]);
}

/// Whether neighbours no nearer than that cannot be corners. An image b of theirs has |b| ≤ ρ = 1/√squared; next to the
/// edge from a to c of the hull, the hull turns inwards at b where
///   (b − a) × (c − b) = b × (c − a) − a × c ≤ ρ |c − a| − a × c
/// is negative by more than the tolerance: where b is inside the hull, and b's neighbour outside all circles.
bool out_of_reach(const Fan& fan, double squared) {
    constexpr double margin = 1e-9;  // well above the tolerance
    std::size_t before = fan.corners - 1;
    for (std::size_t next = 0; next < fan.corners; before = next++) {
        const Ray &a = fan.rays[static_cast<std::size_t>(fan.chain[before])],
                  &c = fan.rays[static_cast<std::size_t>(fan.chain[next])];
        const double cross = a.u * c.v - a.v * c.u - margin * a.size * c.size, u = c.u - a.u, v = c.v - a.v;
        if (!(cross > 0 && cross * cross * squared > u * u + v * v)) return false;
    }
    return true;
}

}  // namespace

void build_fan(const Neighborhood& neighborhood, Vec3 normal, Fan& fan) {
    fan.corners = 0;
    fan.closed = false;
    if (!finite(normal)) return;
    const Frame frame = frame_about(normal);
    if (neighborhood.count > nearest_few) {
        build_among(neighborhood, frame, nearest_few, fan);
        if (fan.closed && out_of_reach(fan, nearest_squared(neighborhood, frame, nearest_few))) return;
    }
    build_among(neighborhood, frame, padded(neighborhood.count), fan);
}

void build_fans(LaneNeighborhoods& around, std::span<const Vec3> normals, std::span<Fan> fans) {
    LaneFans found = {};
    if (around.in_lanes()) {
        LaneValues normal[3] = {};
        for (std::size_t l = 0; l < around.count(); ++l)
            normal[0][l] = normals[l].x, normal[1][l] = normals[l].y, normal[2][l] = normals[l].z;
        best_cloud_kernel().fans(around.patches(), around.counts(), normal, found);
    }
    for (std::size_t l = 0; l < around.count(); ++l) {
        Fan& fan = fans[l];
        fan.corners = static_cast<std::size_t>(found.corners[l]);
        fan.closed = fan.corners > 0;
        for (std::size_t c = 0; c < fan.corners; ++c) fan.chain[c] = found.chain[c][l];
        if (fan.corners == 0) build_fan(around.alone(l), normals[l], fan);
    }
}

}  // namespace gaussmap
