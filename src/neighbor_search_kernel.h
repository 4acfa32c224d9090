// The search of neighbor_search.h for one instruction set. Included by neighbor_search_<set>.cpp alone, each compiled
// for its set; nothing here may have external linkage but the entry that each defines, or the linker could pick a copy
// that the machine cannot run. Every set rounds every operation alike, and results are the exact ones: equal
// everywhere.
//
// Candidates within a bound are collected without order; sorting comes once, at the end. The bound of a query comes
// from queries near it that are done (triangle inequality), and the leaves that it has to look at from a list that its
// whole group shares. A box whose lower bound of distances ties with the bound is weighed by its lowest index, so that
// equal points and grids neither change the answer nor slow it down.
#pragma once

#include "box_kernel.h"
#include "key_sort_kernel.h"
#include "neighbor_search.h"

namespace gaussmap {
namespace {

constexpr double most = std::numeric_limits<double>::max();

#ifdef __AVX2__
/// For every set of lanes, the 32-bit halves of those lanes, and the lanes themselves as bytes of 32-bit words.
struct Packing {
    alignas(32) int halves[16][8];
    alignas(16) unsigned char bytes[16][16];
};
constexpr Packing make_packing() {
    Packing packing{};
    for (int set = 0; set < 16; ++set)
        for (int l = 0, n = 0; l < 4; ++l) {
            if (!(set >> l & 1)) continue;
            packing.halves[set][2 * n] = 2 * l;
            packing.halves[set][2 * n + 1] = 2 * l + 1;
            for (int b = 0; b < 4; ++b) packing.bytes[set][4 * n + b] = static_cast<unsigned char>(4 * l + b);
            ++n;
        }
    return packing;
}
constexpr Packing packing = make_packing();
#endif

struct Candidates {
    double* distance;
    std::int32_t* index;
    std::size_t count;
};

/// Append the lanes under the mask; writes up to `lanes` places beyond.
GAUSSMAP_INLINE void append(Candidates& to, Mask mask, Real distance, const std::int32_t* index) {
#ifdef __AVX2__
    const unsigned set = bits_of(mask);
    const __m256i halves = _mm256_load_si256(reinterpret_cast<const __m256i*>(packing.halves[set]));
    const __m128i bytes = _mm_load_si128(reinterpret_cast<const __m128i*>(packing.bytes[set]));
    const __m128i from = _mm_loadu_si128(reinterpret_cast<const __m128i*>(index));
    store(to.distance + to.count, (Real)_mm256_permutevar8x32_epi32((__m256i)distance, halves));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to.index + to.count), _mm_shuffle_epi8(from, bytes));
    to.count += static_cast<std::size_t>(__builtin_popcount(set));
#else
    for (int l = 0; l < lanes; ++l) {
        to.distance[to.count] = distance[l];
        to.index[to.count] = index[l];
        to.count += static_cast<std::size_t>(mask[l] & 1);
    }
#endif
}

/// Squared radii in which a query expects its k nearest and in which it still looks for them among the leaves of its
/// group, as multiples of the typical squared distance of the k-th nearest of queries before.
constexpr double wide = 2;
inline double narrow(std::size_t k) {
    return 1 + 1.4 / __builtin_sqrt(static_cast<double>(k));
}

/// One query at a time.
class Search {
  public:
    Search(const SearchRoom& room, const QueryGroup& group) : room_(room), group_(group) {}

    /// With nothing known: nearest boxes first, down from the root, or up from the leaf that the query is a point of.
    void alone(int query) {
        const int top = room_.level_count - 1;
        begin(query, {infinity, nobody});
        if (group_.home < 0) {
            visit(top, 0, -1);
        } else {
            std::size_t node = static_cast<std::size_t>(group_.home);
            scan(node);
            for (int level = 0; level <= top && bound_.distance > 0; ++level, node /= children) {
                visit(level, node / children, static_cast<int>(node % children));
                if (candidates_.count >= room_.k) shrink();
            }
            if (!(bound_.distance > 0)) {  // k copies: now only the lowest indices are wanted
                begin(query, {0, nobody});
                visit(top, 0, -1);
            }
        }
        order();
    }

    /// Among the leaves collected, up to a bound; false where fewer than k are within it.
    bool within(int query, double bound, std::size_t leaves);

    /// List the leaves that are within a bound of a box; 0 where they are too many.
    std::size_t collect(const Box& box, double bound);

    double farthest(int query) const { return room_.found_distance[(query + 1) * room_.k - 1]; }

  private:
    void begin(int query, const Found& bound) {
        query_ = query;
        for (int a = 0; a < 3; ++a) q_[a] = group_.p[a][query];
        bound_ = bound;
        candidates_ = {room_.distance, room_.index, 0};
    }
    void scan(std::size_t leaf);
    void visit(int level, std::size_t node, int except);
    void order();
    void shrink();

    const SearchRoom room_;
    const QueryGroup& group_;
    const std::uint32_t* leaves_ = nullptr;
    Candidates candidates_{};
    Found bound_{infinity, nobody};
    double q_[3] = {};
    int query_ = 0;
};

GAUSSMAP_INLINE void Search::scan(std::size_t number) {
    const Leaf& leaf = room_.leaves[number];
    if (candidates_.count + leaf_points > room_.capacity) shrink();
    Candidates candidates = candidates_;
    const Real bound = all(bound_.distance), x = all(q_[0]), y = all(q_[1]), z = all(q_[2]);
    for (int i = 0; i < leaf_points; i += lanes) {
        const Real dx = load(leaf.p[0] + i) - x, dy = load(leaf.p[1] + i) - y, dz = load(leaf.p[2] + i) - z;
        const Real distance = dx * dx + dy * dy + dz * dz;
        append(candidates, distance <= bound, distance, leaf.index + i);
    }
    candidates_.count = candidates.count;
}

/// Look at the children of a node but one.
void Search::visit(int level, std::size_t node, int except) {
    const Boxes& boxes = room_.levels[level][node];
    const Box point = {{q_[0], q_[1], q_[2]}, {q_[0], q_[1], q_[2]}};
    const double* const low[3] = {boxes.low[0], boxes.low[1], boxes.low[2]};
    const double* const high[3] = {boxes.high[0], boxes.high[1], boxes.high[2]};
    double lower[children];
    for (int c = 0; c < children; c += lanes) store(lower + c, gap(point, low, high, static_cast<std::size_t>(c)));
    struct Child {
        Found lower;
        int number;
    } sorted[children];
    int count = 0;
    for (int c = 0; c < children; ++c) {
        const Found bound = {lower[c], boxes.first[c]};
        if (c == except || !nearer(bound, bound_)) continue;
        int at = count++;
        for (; at > 0 && nearer(bound, sorted[at - 1].lower); --at) sorted[at] = sorted[at - 1];
        sorted[at] = {bound, c};
    }
    for (int i = 0; i < count && nearer(sorted[i].lower, bound_); ++i) {
        const std::size_t child = node * children + static_cast<std::size_t>(sorted[i].number);
        if (level == 0)
            scan(child);
        else
            visit(level - 1, child, -1);
    }
}

std::size_t Search::collect(const Box& box, double bound) {
    const Real limit = all(bound);
    std::uint32_t *from = room_.nodes[0], *to = room_.nodes[1];
    const std::size_t most_leaves = room_.most_leaves;
    double* const copy = room_.boxes;
    std::size_t count = 1;
    from[0] = 0;
    for (int level = room_.level_count - 1; level >= 0; --level) {
        std::size_t next = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Boxes& boxes = room_.levels[level][from[i]];
            const double* const low[3] = {boxes.low[0], boxes.low[1], boxes.low[2]};
            const double* const high[3] = {boxes.high[0], boxes.high[1], boxes.high[2]};
            unsigned near = 0;
            for (int c = 0; c < children; c += lanes)
                near |= bits_of(gap(box, low, high, static_cast<std::size_t>(c)) <= limit) << c;
            if (next + children > most_leaves) return 0;
            for (; near; near &= near - 1) {
                const int c = __builtin_ctz(near);
                if (level == 0)
                    for (int a = 0; a < 3; ++a) {
                        copy[static_cast<std::size_t>(2 * a) * most_leaves + next] = boxes.low[a][c];
                        copy[static_cast<std::size_t>(2 * a + 1) * most_leaves + next] = boxes.high[a][c];
                    }
                to[next++] = from[i] * children + static_cast<std::uint32_t>(c);
            }
        }
        count = next;
        std::uint32_t* const done = from;
        from = to, to = done;
    }
    leaves_ = from;
    return count;
}

bool Search::within(int query, double bound, std::size_t leaves) {
    begin(query, {bound, nobody});
    const Box point = {{q_[0], q_[1], q_[2]}, {q_[0], q_[1], q_[2]}};
    const double *const box = room_.boxes, *low[3], *high[3];
    for (int a = 0; a < 3; ++a) {
        low[a] = box + static_cast<std::size_t>(2 * a) * room_.most_leaves;
        high[a] = low[a] + room_.most_leaves;
    }
    for (std::size_t i = 0; i < leaves; i += lanes) {
        unsigned near = bits_of(gap(point, low, high, i) <= all(bound_.distance));
        for (; near; near &= near - 1) {
            const std::size_t at = i + static_cast<std::size_t>(__builtin_ctz(near));
            if (at < leaves) scan(leaves_[at]);
        }
    }
    if (candidates_.count < room_.k) return false;
    order();
    return true;
}

/// The k nearest candidates, in order, as the results of the query. A key is a squared distance whose lowest bits make
/// room for the candidate's place, so that only keys that agree in all others need a second look.
void Search::order() {
    const std::size_t count = candidates_.count, k = room_.k;
    const std::uint64_t places = room_.places;
    const double* const distance = room_.distance;
    const std::int32_t* const index = room_.index;
    for (std::size_t i = 0; i < count; ++i)
        room_.key[i] =
            __builtin_bit_cast(double, (__builtin_bit_cast(std::uint64_t, lesser(distance[i], most)) & ~places) | i);
    double* const key = sort_keys(room_.key, room_.spare, count);
    const auto bits = [key](std::size_t i) { return __builtin_bit_cast(std::uint64_t, key[i]); };
    bool tied = false;
    for (std::size_t i = 0; i < k && i + 1 < count; ++i) tied |= (bits(i) ^ bits(i + 1)) <= places;
    if (tied)
        for (std::size_t i = 0, end; i < k; i = end) {
            for (end = i + 1; end < count && (bits(i) ^ bits(end)) <= places;) ++end;
            if (end > i + 1) order_tied(room_, key + i, key + end);
        }
    double* const found_distance = room_.found_distance + query_ * k;
    std::int32_t* const found = room_.found + query_ * k;
    for (std::size_t i = 0; i < k; ++i) {
        found_distance[i] = distance[bits(i) & places];
        found[i] = index[bits(i) & places];
    }
}

/// Keep the k nearest candidates only.
void Search::shrink() {
    order();
    const double* const found_distance = room_.found_distance + query_ * room_.k;
    const std::int32_t* const found = room_.found + query_ * room_.k;
    for (std::size_t i = 0; i < room_.k; ++i) room_.distance[i] = found_distance[i], room_.index[i] = found[i];
    candidates_.count = room_.k;
    bound_ = {found_distance[room_.k - 1], found[room_.k - 1]};
}

Box box_of(const QueryGroup& group) {
    Box box;
    for (int a = 0; a < 3; ++a) {
        box.low[a] = box.high[a] = group.p[a][0];
        for (int q = 1; q < group.count; ++q) {
            box.low[a] = lesser(box.low[a], group.p[a][q]);
            box.high[a] = greater(box.high[a], group.p[a][q]);
        }
    }
    return box;
}

void nearest(SearchRoom& room, const QueryGroup& group) {
    Search search(room, group);
    double typical = room.typical;
    const double limit = wide * typical;
    const double expected = narrow(room.k);
    const std::size_t leaves = limit > 0 && limit < infinity ? search.collect(box_of(group), limit) : 0;
    for (int q = 0; q < group.count; ++q) {
        const double bound = lesser(limit, expected * typical);
        if (leaves == 0 || !(search.within(q, bound, leaves) || (bound < limit && search.within(q, limit, leaves))))
            search.alone(q);
        const double farthest = search.farthest(q);
        typical = typical < infinity && farthest > 0 ? 0.75 * typical + 0.25 * farthest : farthest;
    }
    room.typical = typical;
}

}  // namespace
}  // namespace gaussmap
