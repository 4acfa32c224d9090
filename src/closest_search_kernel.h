// The search of closest_search.h for one instruction set. Included by closest_search_<set>.cpp alone, each compiled for
// its set; nothing here may have external linkage but the entry that each defines, or the linker could pick a copy that
// the machine cannot run. Every set rounds every operation alike.
//
// Queries come in groups that are near each other. The first of a group is searched for from the root, nearest boxes
// first; its distance bounds those of the others (triangle inequality), so that they share one list of the leaves that
// can matter. Each query begins with the leaf that was closest to the one before. A group that is spread too widely,
// its list too long, goes query by query.
#pragma once

#include "box_kernel.h"
#include "closest_search.h"

namespace gaussmap {
namespace {

GAUSSMAP_INLINE Real clamped(Real a, Real most) {
    return maximum(minimum(a, most), Real{});
}

/// Squared distances of a point from the triangles i, i + 1, … of a leaf; see TriangleLeaf for their frames.
GAUSSMAP_INLINE Real squared_distances(const TriangleLeaf& leaf, int i, const double* q) {
    const Real dx = all(q[0]) - load(leaf.origin[0] + i), dy = all(q[1]) - load(leaf.origin[1] + i),
               dz = all(q[2]) - load(leaf.origin[2] + i);
    const Real x = dx * load(leaf.u[0] + i) + dy * load(leaf.u[1] + i) + dz * load(leaf.u[2] + i);
    const Real y = dx * load(leaf.v[0] + i) + dy * load(leaf.v[1] + i) + dz * load(leaf.v[2] + i);
    const Real z = dx * load(leaf.n[0] + i) + dy * load(leaf.n[1] + i) + dz * load(leaf.n[2] + i);
    const Real base = load(leaf.base + i), apex = load(leaf.apex + i), height = load(leaf.height + i);
    const Real back = apex - base, past = x - base;
    const Real on_start = clamped((x * apex + y * height) * load(leaf.per_start + i), all(1));
    const Real on_end = clamped((past * back + y * height) * load(leaf.per_end + i), all(1));
    const Real bx = x - clamped(x, base);
    const Real sx = x - on_start * apex, sy = y - on_start * height;
    const Real ex = past - on_end * back, ey = y - on_end * height;
    const Real aside = minimum(minimum(bx * bx + y * y, sx * sx + sy * sy), ex * ex + ey * ey);
    const Mask above = (y > Real{}) & (back * y - height * past > Real{}) & (height * x - apex * y > Real{});
    return (Real)((Mask)aside & ~above) + z * z;
}

/// One, but for the rounding of squared distances.
constexpr double below = 1 - 0x1p-46;

struct Closest {
    double squared;
    std::int32_t face;
    std::uint32_t slot;
};

constexpr std::size_t group_queries = 16;
constexpr int most_leaves = 64;

/// The leaves that a group shares, and their boxes.
struct NearLeaves {
    int count;
    std::uint32_t leaf[most_leaves];
    std::int32_t first[most_leaves];
    alignas(32) double low[3][most_leaves], high[3][most_leaves];
};

class Search {
  public:
    Search(const ClosestRoom& room, std::size_t query) : room_(room), q_(room.queries + 3 * query) {}

    /// Among the leaves of a group.
    Closest among(const NearLeaves& near, std::uint32_t start_leaf) {
        scan(start_leaf);
        const Box point = {{q_[0], q_[1], q_[2]}, {q_[0], q_[1], q_[2]}};
        const double* const low[3] = {near.low[0], near.low[1], near.low[2]};
        const double* const high[3] = {near.high[0], near.high[1], near.high[2]};
        for (int i = 0; i < near.count; i += lanes) {
            const Real gaps = gap(point, low, high, static_cast<std::size_t>(i));
            unsigned hits = bits_of(all(below) * gaps <= all(best_.squared));
            for (; hits; hits &= hits - 1) {
                const int l = __builtin_ctz(hits);
                if (i + l < near.count && worth(gaps[l], near.first[i + l])) scan(near.leaf[i + l]);
            }
        }
        return best_;
    }

    Closest find(std::uint32_t start_leaf) {
        scan(start_leaf);
        visit(room_.level_count - 1, 0);
        return best_;
    }

  private:
    void scan(std::size_t number);
    void visit(int level, std::size_t node);
    /// Is a triangle at this distance better?
    bool better(double distance, std::int32_t face) const {
        return distance < best_.squared || (distance == best_.squared && face < best_.face);
    }
    /// Can one in a box be, of no smaller distance than `gap` and no index below `first`? Where rounding could decide,
    /// as among equal triangles, only one of a lower index: so they neither change the answer nor slow it down.
    bool worth(double gap, std::int32_t first) const {
        return gap < below * best_.squared || (below * gap <= best_.squared && first < best_.face);
    }

    const ClosestRoom& room_;
    const double* q_;
    Closest best_{__builtin_inf(), nobody, 0};
};

GAUSSMAP_INLINE void Search::scan(std::size_t number) {
    const TriangleLeaf& leaf = room_.leaves[number];
    for (int i = 0; i < leaf_triangles; i += lanes) {
        const Real distance = squared_distances(leaf, i, q_);
        unsigned near = bits_of(distance <= all(best_.squared));
        for (; near; near &= near - 1) {
            const int l = __builtin_ctz(near), at = i + l;
            if (better(distance[l], leaf.face[at]))
                best_ = {distance[l], leaf.face[at],
                         static_cast<std::uint32_t>(number * leaf_triangles) + static_cast<std::uint32_t>(at)};
        }
    }
}

void Search::visit(int level, std::size_t node) {
    const Boxes& boxes = room_.levels[level][node];
    const Box point = {{q_[0], q_[1], q_[2]}, {q_[0], q_[1], q_[2]}};
    const double* const low[3] = {boxes.low[0], boxes.low[1], boxes.low[2]};
    const double* const high[3] = {boxes.high[0], boxes.high[1], boxes.high[2]};
    double lower[children];
    unsigned near = 0;
    for (int c = 0; c < children; c += lanes) {
        const Real gaps = gap(point, low, high, static_cast<std::size_t>(c));
        store(lower + c, gaps);
        near |= bits_of(all(below) * gaps <= all(best_.squared)) << c;
    }
    int sorted[children], count = 0;
    for (; near; near &= near - 1) {
        const int c = __builtin_ctz(near);
        int at = count++;
        for (; at > 0 && lower[c] < lower[sorted[at - 1]]; --at) sorted[at] = sorted[at - 1];
        sorted[at] = c;
    }
    for (int i = 0; i < count; ++i) {
        const int c = sorted[i];
        if (!worth(lower[c], boxes.first[c])) continue;
        const std::size_t child = node * children + static_cast<std::size_t>(c);
        if (level == 0)
            scan(child);
        else
            visit(level - 1, child);
    }
}

/// List the leaves within a bound of a box; false where they are too many.
bool collect(const ClosestRoom& room, const Box& box, double bound, NearLeaves& near) {
    std::uint32_t lists[2][most_leaves];
    std::uint32_t *from = lists[0], *to = lists[1];
    int count = 1;
    from[0] = 0;
    for (int level = room.level_count - 1; level >= 0; --level) {
        int next = 0;
        for (int i = 0; i < count; ++i) {
            const Boxes& boxes = room.levels[level][from[i]];
            const double* const low[3] = {boxes.low[0], boxes.low[1], boxes.low[2]};
            const double* const high[3] = {boxes.high[0], boxes.high[1], boxes.high[2]};
            unsigned hits = 0;
            for (int c = 0; c < children; c += lanes)
                hits |= bits_of(gap(box, low, high, static_cast<std::size_t>(c)) <= all(bound)) << c;
            if (next + children > most_leaves) return false;
            for (; hits; hits &= hits - 1) {
                const int c = __builtin_ctz(hits);
                if (level == 0) {
                    for (int a = 0; a < 3; ++a)
                        near.low[a][next] = boxes.low[a][c], near.high[a][next] = boxes.high[a][c];
                    near.first[next] = boxes.first[c];
                    near.leaf[next] = from[i] * children + static_cast<std::uint32_t>(c);
                }
                to[next++] = from[i] * children + static_cast<std::uint32_t>(c);
            }
        }
        count = next;
        std::uint32_t* const done = from;
        from = to, to = done;
    }
    near.count = count;
    for (int i = count; i % lanes != 0; ++i)  // the rest of the last register
        for (int a = 0; a < 3; ++a) near.low[a][i] = __builtin_inf(), near.high[a][i] = -__builtin_inf();
    return true;
}

/// Up to 16 queries; returns the leaf that the last of them is closest to.
std::uint32_t closest_of_group(const ClosestRoom& room, const std::int32_t* order, std::size_t count,
                               std::uint32_t leaf, double* squared_distance, std::uint32_t* slot) {
    const auto answer = [&](std::size_t i, const Closest& found) {
        const auto query = static_cast<std::size_t>(order[i]);
        squared_distance[query] = found.squared;
        slot[query] = found.slot;
        leaf = found.slot / leaf_triangles;
    };
    const auto query = [&](std::size_t i) { return room.queries + 3 * static_cast<std::size_t>(order[i]); };
    const Closest first = Search(room, static_cast<std::size_t>(order[0])).find(leaf);
    answer(0, first);
    Box box;
    double spread = 0;
    for (int a = 0; a < 3; ++a) box.low[a] = box.high[a] = query(0)[a];
    for (std::size_t i = 1; i < count; ++i) {
        double apart = 0;
        for (int a = 0; a < 3; ++a) {
            const double q = query(i)[a], d = q - query(0)[a];
            if (q < box.low[a]) box.low[a] = q;
            if (q > box.high[a]) box.high[a] = q;
            apart += d * d;
        }
        if (apart > spread) spread = apart;
    }
    const double bound = __builtin_sqrt(spread) + __builtin_sqrt(first.squared);
    NearLeaves near;
    const bool shared = collect(room, box, bound * bound * (1 + 0x1p-40), near);
    for (std::size_t i = 1; i < count; ++i) {
        Search search(room, static_cast<std::size_t>(order[i]));
        answer(i, shared ? search.among(near, leaf) : search.find(leaf));
    }
    return leaf;
}

void closest(const ClosestRoom& room, const std::int32_t* order, std::size_t count, double* squared_distance,
             std::uint32_t* slot) {
    std::uint32_t leaf = 0;
    for (std::size_t i = 0; i < count; i += group_queries) {
        const std::size_t size = count - i < group_queries ? count - i : group_queries;
        leaf = closest_of_group(room, order + i, size, leaf, squared_distance, slot);
    }
}

}  // namespace
}  // namespace gaussmap
