// The search of closest_search.h for one instruction set. Included by closest_search_<set>.cpp alone, each compiled for
// its set; nothing here may have external linkage but the entry that each defines, or the linker could pick a copy that
// the machine cannot run. Every set rounds every operation alike.
//
// The leaf that was closest to the query before bounds the distance of the next one; what the bound leaves of the tree
// is searched nearest boxes first.
#pragma once

#include "box_kernel.h"
#include "closest_search.h"

namespace gaussmap {
namespace {

#define GAUSSMAP_INLINE inline __attribute__((always_inline))

GAUSSMAP_INLINE Real minimum(Real a, Real b) {
#if defined __AVX2__
    return (Real)_mm256_min_pd((__m256d)a, (__m256d)b);
#elif defined __SSE2__
    return (Real)_mm_min_pd((__m128d)a, (__m128d)b);
#else
    return a < b ? a : b;
#endif
}
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

class Search {
  public:
    Search(const ClosestRoom& room, std::size_t query) : room_(room), q_(room.queries + 3 * query) {}

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

void closest(const ClosestRoom& room, const std::int32_t* order, std::size_t count, double* squared_distance,
             std::uint32_t* slot) {
    std::uint32_t leaf = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto query = static_cast<std::size_t>(order[i]);
        const Closest found = Search(room, query).find(leaf);
        squared_distance[query] = found.squared;
        slot[query] = found.slot;
        leaf = found.slot / leaf_triangles;
    }
}

#undef GAUSSMAP_INLINE

}  // namespace
}  // namespace gaussmap
