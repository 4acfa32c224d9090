// The tree of triangle_tree.h: centroids parted at medians, level by level from the top.
#include "triangle_tree.h"

#include <algorithm>
#include <cmath>

#include "degenerate.h"
#include "frame.h"
#include "parallel.h"

namespace gaussmap {
namespace {

struct Corners {
    Vec3 a, b, c;
};

Corners corners_of(Points vertices, Triangles faces, std::int32_t face) {
    const std::int32_t* abc = faces[static_cast<std::size_t>(face)];
    const auto corner = [&](int i) { return load(vertices[static_cast<std::size_t>(abc[i])]); };
    return {corner(0), corner(1), corner(2)};
}

/// The same triangle, turned so that no side is longer than ab; of equal ones the first.
Corners longest_first(const Corners& t) {
    const double ab = squared(t.b - t.a), bc = squared(t.c - t.b), ca = squared(t.a - t.c);
    if (ab >= bc && ab >= ca) return t;
    if (bc >= ca) return {t.b, t.c, t.a};
    return {t.c, t.a, t.b};
}

/// A unit vector across u in the plane of u and w. The second pass takes out what rounding left along u.
Vec3 across(Vec3 u, Vec3 w) {
    for (int pass = 0; pass < 2; ++pass) w = unit(w - dot(w, u) * u);
    return w;
}

void fill(TriangleLeaf& leaf, int i, std::int32_t face, const Corners& corners) {
    const auto [a, b, c] = longest_first(corners);
    const Vec3 ab = b - a, ac = c - a;
    const double base = length(ab), half_squares = 0.5 * (squared(ab) + squared(ac) + squared(c - b));
    const bool flat = no_area(squared(cross(ab, ac)), half_squares);
    const Vec3 u = base > 0 ? unit(ab) : Vec3{1, 0, 0};
    const Vec3 v = flat ? frame_about(u).u : across(u, ac), n = cross(u, v);
    const double apex = std::clamp(dot(ac, u), 0.0, base), height = flat ? 0 : dot(ac, v);
    const auto inverse = [](double s) { return s > 0 ? 1 / s : 0; };
    const double origin[3] = {a.x, a.y, a.z}, along[3] = {u.x, u.y, u.z}, aside[3] = {v.x, v.y, v.z},
                 up[3] = {n.x, n.y, n.z};
    for (int d = 0; d < 3; ++d) {
        leaf.origin[d][i] = origin[d], leaf.u[d][i] = along[d];
        leaf.v[d][i] = aside[d], leaf.n[d][i] = up[d];
    }
    leaf.base[i] = base, leaf.apex[i] = apex, leaf.height[i] = height;
    leaf.per_start[i] = inverse(apex * apex + height * height);
    leaf.per_end[i] = inverse((apex - base) * (apex - base) + height * height);
    leaf.face[i] = face;
}

void enclose(Boxes& boxes, int child, const Corners& corners, std::int32_t face) {
    for (const Vec3 p : {corners.a, corners.b, corners.c}) {
        const double at[3] = {p.x, p.y, p.z};
        for (int d = 0; d < 3; ++d) {
            boxes.low[d][child] = std::min(boxes.low[d][child], at[d]);
            boxes.high[d][child] = std::max(boxes.high[d][child], at[d]);
        }
    }
    boxes.first[child] = std::min(boxes.first[child], face);
}

/// The faces' indices, parted so that each run of 4·8^l is one node of level l − 1 (of leaves, for l = 0).
std::vector<std::int32_t> parted(Points vertices, Triangles faces, const Execution& run) {
    std::vector<Entry> entries(faces.count);
    for_blocks(faces.count, 1 << 14, part_of(run, 0, 0.1), [&](std::size_t, std::size_t f, std::size_t last) {
        for (; f < last; ++f) {
            const auto face = static_cast<std::int32_t>(f);
            const auto [a, b, c] = corners_of(vertices, faces, face);
            const Vec3 middle = a + (1.0 / 3) * ((b - a) + (c - a));
            entries[f] = {{middle.x, middle.y, middle.z}, face};
        }
    });
    std::size_t node = leaf_triangles;
    while (node < faces.count) node *= children;
    for (double done = 0.1; node > leaf_triangles; node /= children) {
        const std::size_t child = node / children, grain = std::max(node, std::size_t{1} << 12);
        const double next = 0.5 * (done + 1);
        for_blocks(entries.size(), grain, part_of(run, done, next), [&](std::size_t, std::size_t i, std::size_t last) {
            for (; i < last; i += node)
                part(entries.data() + i, entries.data() + std::min(i + node, last), static_cast<std::ptrdiff_t>(child));
        });
        done = next;
    }
    std::vector<std::int32_t> order(entries.size());
    std::transform(entries.begin(), entries.end(), order.begin(), [](const Entry& entry) { return entry.index; });
    return order;
}

}  // namespace

TriangleTree triangle_tree(Points vertices, Triangles faces, const Execution& run) {
    const std::vector<std::int32_t> order = parted(vertices, faces, part_of(run, 0, 0.7));
    TriangleTree tree;
    tree.leaves.resize(block_count(faces.count, leaf_triangles));
    tree.levels.emplace_back(block_count(tree.leaves.size(), children), no_boxes());
    for_blocks(tree.levels[0].size(), 512, part_of(run, 0.7, 1), [&](std::size_t, std::size_t node, std::size_t last) {
        const std::size_t begin = node * children, end = std::min(last * children, tree.leaves.size());
        for (std::size_t l = begin; l < end; ++l)
            for (int i = 0; i < leaf_triangles; ++i) {
                const std::int32_t face =
                    order[std::min(l * leaf_triangles + static_cast<std::size_t>(i), faces.count - 1)];
                const Corners corners = corners_of(vertices, faces, face);
                fill(tree.leaves[l], i, face, corners);
                enclose(tree.levels[0][l / children], static_cast<int>(l % children), corners, face);
            }
    });
    while (tree.levels.back().size() > 1) tree.levels.push_back(join(tree.levels.back()));
    return tree;
}

Offset closest_offset(const TriangleTree& tree, std::uint32_t slot, Vec3 q) {
    const TriangleLeaf& leaf = tree.leaves[slot / leaf_triangles];
    const std::uint32_t i = slot % leaf_triangles;
    const auto along = [&](const double(&axis)[3][leaf_triangles], Vec3 d) {
        return d.x * axis[0][i] + d.y * axis[1][i] + d.z * axis[2][i];
    };
    const Vec3 d = q - Vec3{leaf.origin[0][i], leaf.origin[1][i], leaf.origin[2][i]};
    const double x = along(leaf.u, d), y = along(leaf.v, d), z = along(leaf.n, d);
    const double base = leaf.base[i], apex = leaf.apex[i], height = leaf.height[i];
    const double back = apex - base, past = x - base;
    if (y > 0 && back * y - height * past > 0 && height * x - apex * y > 0) return {0, 0, z};
    const double on_base = std::clamp(x, 0.0, base);
    const double on_start = std::clamp((x * apex + y * height) * leaf.per_start[i], 0.0, 1.0);
    const double on_end = std::clamp((past * back + y * height) * leaf.per_end[i], 0.0, 1.0);
    Offset best{x - on_base, y, z};
    for (const Offset& other :
         {Offset{past - on_end * back, y - on_end * height, z}, Offset{x - on_start * apex, y - on_start * height, z}})
        if (other.squared() < best.squared()) best = other;
    return best;
}

Vec3 closest_point(const TriangleTree& tree, std::uint32_t slot, Vec3 q) {
    const TriangleLeaf& leaf = tree.leaves[slot / leaf_triangles];
    const std::uint32_t i = slot % leaf_triangles;
    const auto axis = [&](const double(&of)[3][leaf_triangles]) { return Vec3{of[0][i], of[1][i], of[2][i]}; };
    const Offset offset = closest_offset(tree, slot, q);
    return q - (offset.x * axis(leaf.u) + offset.y * axis(leaf.v) + offset.z * axis(leaf.n));
}

}  // namespace gaussmap
