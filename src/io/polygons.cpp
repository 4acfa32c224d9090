#include "io/polygons.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "io/rows.h"
#include "vec.h"

namespace gaussmap::io {

namespace {

/// Cutting ears takes time quadratic in the corners; a polygon of more than this takes the fan.
constexpr std::size_t most_ear_corners = 1000;

struct Vec2 {
    double x = 0, y = 0;
};

Vec2 operator-(Vec2 a, Vec2 b) {
    return {a.x - b.x, a.y - b.y};
}
double cross(Vec2 a, Vec2 b) {
    return a.x * b.y - a.y * b.x;
}
/// Twice the signed area of a b c.
double area(Vec2 a, Vec2 b, Vec2 c) {
    return cross(b - a, c - a);
}

void add_fan(std::span<const std::int32_t> ring, std::vector<std::int32_t>& triples) {
    for (std::size_t i = 2; i < ring.size(); ++i) triples.insert(triples.end(), {ring[0], ring[i - 1], ring[i]});
}

/// The diagonal that leaves two triangles facing as the quad does; of two such the shorter one.
void cut_quad(const std::vector<double>& vertices, std::span<const std::int32_t> corners,
              std::vector<std::int32_t>& triples) {
    Vec3 p[4];
    for (int i = 0; i < 4; ++i) p[i] = load(vertices.data() + 3 * static_cast<std::size_t>(corners[i]));
    const Vec3 normal = cross(p[2] - p[0], p[3] - p[1]);
    const auto faces_up = [&](int a, int b, int c) { return dot(cross(p[b] - p[a], p[c] - p[a]), normal) > 0; };
    const bool first = faces_up(0, 1, 2) && faces_up(0, 2, 3);
    const bool second = faces_up(0, 1, 3) && faces_up(1, 2, 3);
    if (second && (!first || squared(p[3] - p[1]) < squared(p[2] - p[0]))) {
        triples.insert(triples.end(), {0, 1, 3, 1, 2, 3});
    } else {
        triples.insert(triples.end(), {0, 1, 2, 0, 2, 3});
    }
}

/// The corners in the plane across their Newell normal, counter-clockwise; empty where there is no such plane.
std::vector<Vec2> flatten(const std::vector<double>& vertices, std::span<const std::int32_t> corners) {
    const auto corner = [&](std::size_t i) { return load(vertices.data() + 3 * static_cast<std::size_t>(corners[i])); };
    const Vec3 origin = corner(0);
    Vec3 normal, previous = corner(corners.size() - 1) - origin;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 p = corner(i) - origin;
        normal = normal + cross(previous, p);
        previous = p;
    }
    const double size = length(normal);
    if (!(size > 0) || !std::isfinite(size)) return {};
    normal = (1 / size) * normal;
    // Any tangent serves; the axis least along the normal gives a well-conditioned one.
    const Vec3 a{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    const Vec3 axis = a.x <= a.y && a.x <= a.z ? Vec3{1, 0, 0} : a.y <= a.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    const Vec3 u = cross(axis, normal), v = cross(normal, u);
    std::vector<Vec2> flat(corners.size());
    for (std::size_t i = 0; i < flat.size(); ++i) flat[i] = {dot(corner(i) - origin, u), dot(corner(i) - origin, v)};
    return flat;
}

/// Whether the triangles of the fan from the first corner all turn the same way, and not once around it: they then
/// cover the polygon without overlap.
bool fan_covers(const std::vector<Vec2>& p) {
    const Vec2 start = p[1] - p[0];
    bool past_half_turn = false;
    for (std::size_t i = 2; i < p.size(); ++i) {
        if (!(area(p[0], p[i - 1], p[i]) > 0)) return false;
        const double side = cross(start, p[i] - p[0]);
        if (past_half_turn && side >= 0) return false;
        past_half_turn = past_half_turn || side < 0;
    }
    return true;
}

/// Whether corner i of the ring can be cut off: it is convex, and no other corner lies in its triangle.
bool is_ear(const std::vector<Vec2>& flat, const std::vector<std::int32_t>& ring, std::size_t i) {
    const std::size_t n = ring.size();
    const Vec2 a = flat[ring[(i + n - 1) % n]], b = flat[ring[i]], c = flat[ring[(i + 1) % n]];
    if (!(area(a, b, c) > 0)) return false;
    const auto same = [](Vec2 s, Vec2 t) { return s.x == t.x && s.y == t.y; };
    for (const std::int32_t k : ring) {
        const Vec2 p = flat[k];
        const bool inside = area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
        if (inside && !same(p, a) && !same(p, b) && !same(p, c)) return false;
    }
    return true;
}

/// Ears are cut off in turn until a triangle, or a rest without an ear, is left.
void cut_ears(const std::vector<Vec2>& flat, std::vector<std::int32_t>& triples) {
    std::vector<std::int32_t> ring(flat.size());
    std::iota(ring.begin(), ring.end(), 0);
    std::size_t i = 0, refused = 0;
    while (ring.size() > 3 && refused < ring.size()) {
        const std::size_t n = ring.size();
        if (is_ear(flat, ring, i)) {
            triples.insert(triples.end(), {ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]});
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
            refused = 0;
            if (i == ring.size()) i = 0;
        } else {
            ++refused;
            i = (i + 1) % n;
        }
    }
    add_fan(ring, triples);
}

}  // namespace

void triangulate_polygon(const std::vector<double>& vertices, std::span<const std::int32_t> corners,
                         std::vector<std::int32_t>& triples) {
    if (corners.size() == 4) return cut_quad(vertices, corners, triples);
    if (corners.size() > 4 && corners.size() <= most_ear_corners) {
        const std::vector<Vec2> flat = flatten(vertices, corners);
        if (!flat.empty() && !fan_covers(flat)) return cut_ears(flat, triples);
    }
    for (std::int32_t i = 2; i < static_cast<std::int32_t>(corners.size()); ++i) {
        triples.insert(triples.end(), {0, i - 1, i});
    }
}

void FaceList::reserve(std::size_t faces) {
    corners_.reserve(3 * faces);
}

bool FaceList::add(std::span<const std::int32_t> corners) {
    if (corners.size() == 3) {
        add_triangle(corners[0], corners[1], corners[2]);
        return true;
    }
    if (corners.size() < 3) {
        dropped_.push_back(count() + dropped_.size());
        return false;
    }
    if (offsets_.empty()) {
        offsets_.resize(corners_.size() / 3 + 1);
        for (std::size_t i = 0; i < offsets_.size(); ++i) offsets_[i] = 3 * i;
    }
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    offsets_.push_back(corners_.size());
    return true;
}

void FaceList::add_triangle(std::int32_t a, std::int32_t b, std::int32_t c) {
    corners_.insert(corners_.end(), {a, b, c});
    if (!offsets_.empty()) offsets_.push_back(corners_.size());
}

std::size_t FaceList::count() const {
    return offsets_.empty() ? corners_.size() / 3 : offsets_.size() - 1;
}

void FaceList::check(std::size_t vertices, const Source& source) const {
    // Read as unsigned, a negative index is a large one.
    const auto limit =
        static_cast<std::uint32_t>(std::min<std::size_t>(vertices, std::numeric_limits<std::int32_t>::max()));
    std::size_t at = 0;
    while (at < corners_.size() && static_cast<std::uint32_t>(corners_[at]) < limit) ++at;
    if (at == corners_.size()) return;
    std::uint64_t face = at / 3, first = 3 * face;
    if (!offsets_.empty()) {
        const auto after = std::upper_bound(offsets_.begin(), offsets_.end(), at);
        face = static_cast<std::uint64_t>(after - offsets_.begin()) - 1;
        first = offsets_[face];
    }
    const std::uint64_t corner = at - first;
    for (const std::uint64_t gap : dropped_) face += gap <= face ? 1 : 0;
    fail(source, "face " + std::to_string(face + 1) + ", corner " + std::to_string(corner + 1),
         "vertex index " + std::to_string(corners_[at]) + " (counted from 0) is outside [0, " +
             std::to_string(vertices) + ")",
         "mend the file or write it anew");
}

void FaceList::finish(Geometry& geometry, const Source& source) {
    check(geometry.vertex_count(), source);
    if (!dropped_.empty()) {
        geometry.notes.push_back(counted(dropped_.size(), "face") + " of fewer than 3 corners left out");
    }
    if (offsets_.empty()) {
        geometry.faces = std::move(corners_);
        return;
    }
    if (count() > std::numeric_limits<std::int32_t>::max()) fail(source, "faces", "more than 2147483647 polygons");
    const std::size_t triangles = corners_.size() - 2 * count();
    geometry.faces.reserve(3 * triangles);
    geometry.polygon_of.reserve(triangles);
    geometry.polygon_corner.reserve(3 * triangles);
    for (std::size_t f = 0; f < count(); ++f) {
        const std::span corners(corners_.data() + offsets_[f], offsets_[f + 1] - offsets_[f]);
        const std::size_t begin = geometry.polygon_corner.size();
        triangulate_polygon(geometry.vertices, corners, geometry.polygon_corner);
        for (std::size_t i = begin; i < geometry.polygon_corner.size(); ++i) {
            geometry.faces.push_back(corners[geometry.polygon_corner[i]]);
        }
        geometry.polygon_of.resize(geometry.faces.size() / 3, static_cast<std::int32_t>(f));
    }
    geometry.polygons = {std::move(offsets_), std::move(corners_)};
}

}  // namespace gaussmap::io
