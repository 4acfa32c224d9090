// Counting by sorted flat arrays. The sides of the faces are grouped by their lower vertex and each group is sorted by
// the higher one, so that the faces of an edge lie side by side; connected parts are counted by union-find.

#include "gaussmap/inspect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "check.h"
#include "degenerate.h"
#include "gaussmap/neighbors.h"
#include "vec.h"

namespace gaussmap {
namespace {

/// Sets that are united two at a time; their number is the number of roots.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    bool is_root(std::size_t i) const { return parent_[i] == i; }
    void unite(std::size_t a, std::size_t b) {
        a = root(a), b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::size_t> parent_;
};

/// Items of a vertex each, vertex by vertex: those of v are items[begin[v]] … items[begin[v + 1] − 1], sorted.
template <class Item>
struct Groups {
    std::vector<std::size_t> begin;
    std::vector<Item> items;
};

/// `for_each(put)` calls put(vertex, item) for every item, the same each time it is called.
template <class Item, class ForEach>
Groups<Item> grouped(std::size_t vertices, ForEach&& for_each) {
    Groups<Item> groups;
    groups.begin.resize(vertices + 2);
    for_each([&](std::size_t vertex, const Item&) { ++groups.begin[vertex + 2]; });
    std::partial_sum(groups.begin.begin(), groups.begin.end(), groups.begin.begin());
    groups.items.resize(groups.begin.back());
    // begin[v + 1] is where the next item of v goes, and ends as where those of v + 1 begin.
    for_each([&](std::size_t vertex, const Item& item) { groups.items[groups.begin[vertex + 1]++] = item; });
    groups.begin.pop_back();
    for (std::size_t v = 0; v < vertices; ++v)
        std::sort(groups.items.begin() + static_cast<std::ptrdiff_t>(groups.begin[v]),
                  groups.items.begin() + static_cast<std::ptrdiff_t>(groups.begin[v + 1]));
    return groups;
}

bool repeats_a_vertex(const std::int32_t* abc) {
    return abc[0] == abc[1] || abc[1] == abc[2] || abc[2] == abc[0];
}

/// A side of a face, grouped by the lower of its two vertices.
struct Side {
    std::int32_t higher = 0;
    bool downwards = false;  ///< the face runs from the higher to the lower vertex
    std::size_t corner = 0;  ///< 3·face + the corner at which the side begins

    bool operator<(const Side& other) const {
        return higher != other.higher ? higher < other.higher : corner < other.corner;
    }
    std::size_t face() const { return corner / 3; }
    std::size_t next_corner() const { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    std::size_t corner_at_lower() const { return downwards ? next_corner() : corner; }
    std::size_t corner_at_higher() const { return downwards ? corner : next_corner(); }
};

Groups<Side> sides_of(Triangles faces, std::size_t vertices) {
    return grouped<Side>(vertices, [&](auto&& put) {
        for (std::size_t f = 0; f < faces.count; ++f) {
            if (repeats_a_vertex(faces[f])) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::int32_t from = faces[f][c], to = faces[f][(c + 1) % 3];
                put(static_cast<std::size_t>(std::min(from, to)), Side{std::max(from, to), to < from, 3 * f + c});
            }
        }
    });
}

/// Call visit(lower vertex, first side, one past the last side) for every edge.
template <class Visit>
void for_each_edge(const Groups<Side>& sides, Visit&& visit) {
    for (std::size_t v = 0; v + 1 < sides.begin.size(); ++v) {
        const Side* side = sides.items.data() + sides.begin[v];
        const Side* const end = sides.items.data() + sides.begin[v + 1];
        while (side != end) {
            const Side* const first = side;
            while (side != end && side->higher == first->higher) ++side;
            visit(v, first, side);
        }
    }
}

void count_points(Points vertices, Inspection& found) {
    const DistinctPoints distinct = distinct_points(vertices);
    found.non_finite = distinct.non_finite;
    found.duplicate_vertices = distinct.duplicates;
    if (distinct.points.empty()) return;
    for (int axis = 0; axis < 3; ++axis) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t i = static_cast<std::size_t>(axis); i < distinct.points.size(); i += 3)
            low = std::min(low, distinct.points[i]), high = std::max(high, distinct.points[i]);
        found.minimum[axis] = low, found.maximum[axis] = high;
    }
    found.diagonal = std::hypot(found.maximum[0] - found.minimum[0], found.maximum[1] - found.minimum[1],
                                found.maximum[2] - found.minimum[2]);
}

void count_faces(Points vertices, Triangles faces, Inspection& found) {
    std::vector<bool> used(vertices.count, false);
    for (std::size_t f = 0; f < faces.count; ++f) {
        const std::int32_t* abc = faces[f];
        for (int c = 0; c < 3; ++c) used[static_cast<std::size_t>(abc[c])] = true;
        if (repeats_a_vertex(abc)) {
            ++found.degenerate_faces;
            continue;
        }
        const Vec3 a = load(vertices[static_cast<std::size_t>(abc[0])]);
        const Vec3 ab = load(vertices[static_cast<std::size_t>(abc[1])]) - a;
        const Vec3 ac = load(vertices[static_cast<std::size_t>(abc[2])]) - a;
        const double cross_squared = squared(cross(ab, ac));
        const double half_squares = 0.5 * (squared(ab) + squared(ac) + squared(ac - ab));
        if (no_area(cross_squared, half_squares))
            ++found.degenerate_faces;
        else if (std::isfinite(cross_squared))
            found.area += std::sqrt(cross_squared) / 2;
    }
    found.isolated_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
}

void count_duplicate_faces(Triangles faces, std::size_t vertices, Inspection& found) {
    using Others = std::array<std::int32_t, 2>;
    const Groups<Others> groups = grouped<Others>(vertices, [&](auto&& put) {
        for (std::size_t f = 0; f < faces.count; ++f) {
            std::array<std::int32_t, 3> abc{faces[f][0], faces[f][1], faces[f][2]};
            std::sort(abc.begin(), abc.end());
            put(static_cast<std::size_t>(abc[0]), Others{abc[1], abc[2]});
        }
    });
    for (std::size_t v = 0; v < vertices; ++v)
        for (std::size_t i = groups.begin[v] + 1; i < groups.begin[v + 1]; ++i)
            found.duplicate_faces += groups.items[i] == groups.items[i - 1] ? 1 : 0;
}

void count_edges(Points vertices, const Groups<Side>& sides, Inspection& found) {
    DisjointSets loops(vertices.count);
    std::vector<bool> on_border(vertices.count, false);
    double length_sum = 0;
    std::size_t lengths = 0;
    for_each_edge(sides, [&](std::size_t low, const Side* first, const Side* end) {
        const auto high = static_cast<std::size_t>(first->higher);
        ++found.edges;
        const double edge = length(load(vertices[high]) - load(vertices[low]));
        if (std::isfinite(edge)) length_sum += edge, ++lengths;
        if (end - first == 1) {
            ++found.boundary_edges;
            on_border[low] = on_border[high] = true;
            loops.unite(low, high);
        } else if (end - first > 2) {
            ++found.non_manifold_edges;
        } else if (first[0].downwards == first[1].downwards) {
            ++found.inconsistent_edges;
        }
    });
    for (std::size_t v = 0; v < vertices.count; ++v) found.boundary_loops += on_border[v] && loops.is_root(v) ? 1 : 0;
    if (lengths > 0) found.mean_edge = length_sum / static_cast<double>(lengths);
}

void count_components(Triangles faces, const Groups<Side>& sides, Inspection& found) {
    DisjointSets parts(faces.count);
    for_each_edge(sides, [&](std::size_t, const Side* first, const Side* end) {
        for (const Side* side = first + 1; side < end; ++side) parts.unite(first->face(), side->face());
    });
    for (std::size_t f = 0; f < faces.count; ++f)
        found.components += !repeats_a_vertex(faces[f]) && parts.is_root(f) ? 1 : 0;
}

/// Corners of faces that share an edge at a vertex are united: each set left is one fan of that vertex.
void count_non_manifold_vertices(Triangles faces, std::size_t vertices, const Groups<Side>& sides, Inspection& found) {
    DisjointSets fans(3 * faces.count);
    std::vector<bool> on_non_manifold_edge(vertices, false);
    for_each_edge(sides, [&](std::size_t low, const Side* first, const Side* end) {
        if (end - first > 2)
            on_non_manifold_edge[low] = on_non_manifold_edge[static_cast<std::size_t>(first->higher)] = true;
        for (const Side* side = first + 1; side < end; ++side) {
            fans.unite(first->corner_at_lower(), side->corner_at_lower());
            fans.unite(first->corner_at_higher(), side->corner_at_higher());
        }
    });
    std::vector<std::uint8_t> fan_count(vertices, 0);  // 2 means 2 or more
    for (std::size_t corner = 0; corner < 3 * faces.count; ++corner) {
        if (repeats_a_vertex(faces[corner / 3]) || !fans.is_root(corner)) continue;
        std::uint8_t& count = fan_count[static_cast<std::size_t>(faces.abc[corner])];
        if (count < 2) ++count;
    }
    for (std::size_t v = 0; v < vertices; ++v)
        found.non_manifold_vertices += fan_count[v] == 2 && !on_non_manifold_edge[v] ? 1 : 0;
}

}  // namespace

Inspection inspect(Points vertices, Triangles faces) {
    check_faces(faces, vertices.count);
    Inspection found;
    found.vertices = vertices.count;
    found.faces = faces.count;
    count_points(vertices, found);
    if (faces.empty()) return found;
    count_faces(vertices, faces, found);
    count_duplicate_faces(faces, vertices.count, found);
    const Groups<Side> sides = sides_of(faces, vertices.count);
    count_edges(vertices, sides, found);
    count_components(faces, sides, found);
    count_non_manifold_vertices(faces, vertices.count, sides, found);
    return found;
}

}  // namespace gaussmap
