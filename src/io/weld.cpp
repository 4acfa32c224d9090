// Vertices at the same place become one; polygons become their triangles.
#include <algorithm>
#include <bit>
#include <cmath>

#include "gaussmap/io.h"
#include "io/face_rows.h"
#include "io/polygons.h"
#include "io/rows.h"
#include "io/types.h"

namespace gaussmap {

namespace {

using io::select_rows;

/// MeshLab's list of texture coordinates, 2 a corner.
bool holds_corners(const Property& p) {
    return p.list && p.name == "texcoord";
}

/// For each row to make: the item it comes from and the corners of it that stay.
struct CornerChoice {
    std::vector<std::uint64_t> items;
    std::vector<std::uint64_t> offsets{0};  ///< into `corners`, one more than there are items
    std::vector<std::int32_t> corners;
};

/// The property for the chosen corners; a list that does not hold 2 values a corner is taken whole.
Property select_corners(const Property& property, const CornerChoice& choice, const io::FaceRows& faces) {
    if (!holds_corners(property)) return select_rows(property, choice.items);
    Property out = property;
    out.bytes.clear();
    out.offsets.assign(1, 0);
    const std::size_t size = size_of(property.type);
    for (std::size_t i = 0; i < choice.items.size(); ++i) {
        const auto [first, last] = io::values_of(property, choice.items[i]);
        const auto copy = [&](std::size_t from, std::size_t count) {
            const std::byte* const begin = property.bytes.data() + from * size;
            out.bytes.insert(out.bytes.end(), begin, begin + count * size);
        };
        if (last - first == 2 * faces[choice.items[i]].size()) {
            for (std::uint64_t c = choice.offsets[i]; c < choice.offsets[i + 1]; ++c) {
                copy(first + 2 * static_cast<std::size_t>(choice.corners[c]), 2);
            }
        } else {
            copy(first, last - first);
        }
        out.offsets.push_back(out.values());
    }
    return out;
}

std::uint64_t hash(const double* p) {
    std::uint64_t h = 0;
    for (int c = 0; c < 3; ++c) {
        h ^= std::bit_cast<std::uint64_t>(p[c] + 0.0);  // −0 becomes 0
        h *= 0x9e3779b97f4a7c15u;                       // the golden ratio: every bit reaches the upper half
        h ^= h >> 32;
    }
    return h;
}

/// For each vertex the first one at the same place; one that is not finite stands for itself.
std::vector<std::uint64_t> first_at_same_place(const std::vector<double>& vertices) {
    const std::size_t count = vertices.size() / 3;
    const std::size_t mask = std::bit_ceil(2 * count + 1) - 1;
    constexpr std::uint64_t none = ~std::uint64_t{0};
    std::vector<std::uint64_t> table(mask + 1, none), first(count);
    for (std::size_t v = 0; v < count; ++v) {
        first[v] = v;
        const double* const p = vertices.data() + 3 * v;
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
        std::size_t slot = hash(p) & mask;
        const auto here = [&](const double* q) { return p[0] == q[0] && p[1] == q[1] && p[2] == q[2]; };
        while (table[slot] != none && !here(vertices.data() + 3 * table[slot])) slot = (slot + 1) & mask;
        if (table[slot] == none) table[slot] = v;
        first[v] = table[slot];
    }
    return first;
}

std::vector<double> select_points(const std::vector<double>& points, const std::vector<std::uint64_t>& rows) {
    std::vector<double> out;
    out.reserve(points.empty() ? 0 : 3 * rows.size());
    for (const std::uint64_t row : points.empty() ? std::vector<std::uint64_t>{} : rows) {
        out.insert(out.end(), {points[3 * row], points[3 * row + 1], points[3 * row + 2]});
    }
    return out;
}

/// Elements that number the vertices (edges, say) mean nothing once vertices have gone.
void drop_vertex_elements(Geometry& geometry) {
    std::erase_if(geometry.elements, [&](const Element& element) {
        const bool numbers = std::any_of(element.properties.begin(), element.properties.end(),
                                         [](const Property& p) { return p.name.starts_with("vertex"); });
        if (numbers) geometry.notes.push_back("element " + element.name + " left out: its vertices have new numbers");
        return numbers;
    });
}

/// The faces with their vertices renamed; corners that repeat the one before, and faces of fewer than 3, go.
void weld_faces(const Geometry& from, const std::vector<std::int32_t>& renamed, Geometry& to) {
    const io::FaceRows faces(from);
    CornerChoice choice;
    io::FaceList list;
    std::vector<std::int32_t> corners, kept;
    for (std::size_t f = 0; f < faces.count(); ++f) {
        const auto face = faces[f];
        corners.clear(), kept.clear();
        for (std::size_t c = 0; c < face.size(); ++c) {
            const std::int32_t v = renamed[face[c]];
            const std::int32_t before = renamed[face[(c + face.size() - 1) % face.size()]];
            if (v != before) corners.push_back(v), kept.push_back(static_cast<std::int32_t>(c));
        }
        if (!list.add(corners)) continue;
        choice.items.push_back(f);
        choice.corners.insert(choice.corners.end(), kept.begin(), kept.end());
        choice.offsets.push_back(choice.corners.size());
    }
    const std::string name = "weld";
    list.finish(to, {{}, name, {}});
    for (const Property& p : from.face_properties) to.face_properties.push_back(select_corners(p, choice, faces));
}

}  // namespace

Geometry weld(const Geometry& geometry) {
    io::check(geometry);
    const std::vector<std::uint64_t> first = first_at_same_place(geometry.vertices);
    std::vector<std::uint64_t> kept;
    std::vector<std::int32_t> renamed(first.size());
    for (std::size_t v = 0; v < first.size(); ++v) {
        renamed[v] = first[v] == v ? static_cast<std::int32_t>(kept.size()) : renamed[first[v]];
        if (first[v] == v) kept.push_back(v);
    }
    Geometry out;
    out.vertices = select_points(geometry.vertices, kept);
    out.normals = select_points(geometry.normals, kept);
    out.vertex_type = geometry.vertex_type;
    out.normal_type = geometry.normal_type;
    for (const Property& p : geometry.vertex_properties) out.vertex_properties.push_back(select_rows(p, kept));
    out.elements = geometry.elements;
    out.comments = geometry.comments;
    out.notes = geometry.notes;
    const std::size_t merged = first.size() - kept.size();
    out.notes.push_back(std::to_string(merged) + (merged == 1 ? " vertex" : " vertices") +
                        " merged into another at the same place");
    if (merged > 0) drop_vertex_elements(out);
    if (merged == 0) out.width = geometry.width;
    weld_faces(geometry, renamed, out);
    return out;
}

Geometry triangulate(const Geometry& geometry) {
    io::check(geometry);
    Geometry out = geometry;
    if (geometry.polygons.empty()) return out;
    CornerChoice choice;
    choice.items.assign(geometry.polygon_of.begin(), geometry.polygon_of.end());
    choice.corners = geometry.polygon_corner;
    choice.offsets.resize(choice.items.size() + 1);
    for (std::size_t i = 0; i < choice.offsets.size(); ++i) choice.offsets[i] = 3 * i;
    const io::FaceRows faces(geometry);
    for (Property& p : out.face_properties) p = select_corners(p, choice, faces);
    out.polygons = {};
    out.polygon_of.clear();
    out.polygon_corner.clear();
    return out;
}

}  // namespace gaussmap
