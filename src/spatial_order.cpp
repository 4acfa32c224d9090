// Points in the order of a space-filling curve: Morton's ("A Computer Oriented Geodetic Data Base", 1966), 10 bits an
// axis, by radix sort; cells that hold several points are ordered in the same way within their own boxes, so that far
// clusters, lines and outliers are resolved as finely as the rest and the order depends on positions alone.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "check_cloud.h"
#include "gaussmap/neighbors.h"
#include "parallel.h"
#include "vec.h"

namespace gaussmap {
namespace {

constexpr int axis_bits = 10, digit_bits = 10, digits = 3;
constexpr std::size_t block = std::size_t{1} << 16;
constexpr std::size_t few = 32;        // ordered by comparison
constexpr std::size_t some = 1 << 12;  // keys sorted by comparison

using Histogram = std::array<std::uint32_t, 1 << digit_bits>;

/// A cube about some points: half its lowest corner and half its edge, so that no difference overflows.
struct Cube {
    Vec3 low;
    double edge;
};

/// The low 10 bits of v, two zeros after each.
std::uint64_t spread(std::uint64_t v) {
    v = (v | v << 16) & 0x030000ff;
    v = (v | v << 8) & 0x0300f00f;
    v = (v | v << 4) & 0x030c30c3;
    return (v | v << 2) & 0x09249249;
}

std::uint64_t morton(const Cube& cube, Vec3 p) {
    constexpr int cells = 1 << axis_bits;
    const auto cell = [&](double v, double low) {
        const int at = static_cast<int>((0.5 * v - low) / cube.edge * cells);
        return spread(static_cast<std::uint64_t>(std::min(at, cells - 1)));
    };
    return cell(p.x, cube.low.x) << 2 | cell(p.y, cube.low.y) << 1 | cell(p.z, cube.low.z);
}

/// Items hold a key in their upper half, the index of a point in their lower one.
using Item = std::uint64_t;

std::int32_t index_of(Item item) {
    return static_cast<std::int32_t>(item & 0xffffffffu);
}

class Orderer {
  public:
    explicit Orderer(Points points) : points_(points) {}

    /// Order items[0, count), which come by ascending index. `room` holds as many.
    void order(Item* items, Item* room, std::size_t count, const Execution& run) const {
        const Cube cube = count > few ? cube_of(items, count, run) : Cube{{}, 0};
        if (!(cube.edge > 0)) return compare(items, count);
        for_blocks(count, block, part_of(run, 0.2, 0.4), [&](std::size_t, std::size_t i, std::size_t last) {
            for (; i < last; ++i) {
                const std::int32_t index = index_of(items[i]);
                items[i] = morton(cube, at(index)) << 32 | static_cast<Item>(index);
            }
        });
        if (count <= some)
            std::sort(items, items + count);
        else
            radix_sort(items, room, count, run);
        order_runs(items, room, count, part_of(run, 0.7, 1));
    }

  private:
    Vec3 at(std::int32_t index) const { return load(points_[static_cast<std::size_t>(index)]); }

    void compare(Item* items, std::size_t count) const {
        std::sort(items, items + count, [this](Item a, Item b) {
            const Vec3 p = at(index_of(a)), q = at(index_of(b));
            if (p.x != q.x) return p.x < q.x;
            if (p.y != q.y) return p.y < q.y;
            if (p.z != q.z) return p.z < q.z;
            return index_of(a) < index_of(b);
        });
    }

    Cube cube_of(const Item* items, std::size_t count, const Execution& run) const;
    void order_runs(Item* items, Item* room, std::size_t count, const Execution& run) const;
    static void radix_sort(Item* items, Item* room, std::size_t count, const Execution& run);

    Points points_;
};

Cube Orderer::cube_of(const Item* items, std::size_t count, const Execution& run) const {
    const Vec3 first = at(index_of(items[0]));
    std::vector<std::array<Vec3, 2>> boxes(block_count(count, block));
    for_blocks(count, block, part_of(run, 0, 0.2), [&](std::size_t b, std::size_t i, std::size_t last) {
        Vec3 low = first, high = first;
        for (; i < last; ++i) {
            const Vec3 p = at(index_of(items[i]));
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        boxes[b] = {low, high};
    });
    Vec3 low = first, high = first;
    for (const auto& [l, h] : boxes) {
        low = {std::min(low.x, l.x), std::min(low.y, l.y), std::min(low.z, l.z)};
        high = {std::max(high.x, h.x), std::max(high.y, h.y), std::max(high.z, h.z)};
    }
    const Vec3 half = 0.5 * low, extent = 0.5 * high - half;
    return {half, std::max({extent.x, extent.y, extent.z})};
}

/// By key, stable, least significant digit first; every block counts and moves its own items.
void Orderer::radix_sort(Item* items, Item* room, std::size_t count, const Execution& run) {
    const auto digit = [](Item item, int pass) { return item >> (32 + digit_bits * pass) & ((1 << digit_bits) - 1); };
    std::vector<Histogram> places(block_count(count, block));
    Item *from = items, *to = room;
    for (int pass = 0; pass < digits; ++pass, std::swap(from, to)) {
        const Execution part = part_of(run, 0.4 + 0.1 * pass, 0.5 + 0.1 * pass);
        for_blocks(count, block, part_of(part, 0, 0.5), [&](std::size_t b, std::size_t i, std::size_t last) {
            places[b].fill(0);
            for (; i < last; ++i) ++places[b][digit(from[i], pass)];
        });
        std::uint32_t place = 0;
        for (std::size_t d = 0; d < Histogram().size(); ++d)
            for (Histogram& of_block : places) place += std::exchange(of_block[d], place);
        for_blocks(count, block, part_of(part, 0.5, 1), [&](std::size_t b, std::size_t i, std::size_t last) {
            for (; i < last; ++i) to[places[b][digit(from[i], pass)]++] = from[i];
        });
    }
    std::copy(room, room + count, items);
}

/// Order every run of equal keys. A run belongs to the block in which it begins.
void Orderer::order_runs(Item* items, Item* room, std::size_t count, const Execution& run) const {
    const auto begins = [&](std::size_t i) { return i == 0 || i >= count || items[i - 1] >> 32 != items[i] >> 32; };
    std::vector<std::size_t> cuts(block_count(count, block) + 1);
    for (std::size_t b = 0; b < cuts.size(); ++b)
        for (cuts[b] = std::min(count, b * block); !begins(cuts[b]);) ++cuts[b];
    for_blocks(cuts.size() - 1, 1, run, [&](std::size_t b, std::size_t, std::size_t) {
        for (std::size_t i = cuts[b], end; i < cuts[b + 1]; i = end) {
            const Item key = items[i] >> 32;
            for (end = i + 1; end < cuts[b + 1] && items[end] >> 32 == key;) ++end;
            if (end > i + 1) order(items + i, room + i, end - i, {1, {}});
        }
    });
}

}  // namespace

std::vector<std::int32_t> spatial_order(Points points, const Execution& run) {
    check_countable(points);
    std::vector<Item> items(points.count), room(points.count);
    for_blocks(points.count, block, part_of(run, 0, 0.1), [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) {
            if (!finite(load(points[i])))
                throw std::invalid_argument("points[" + std::to_string(i) +
                                            "] is not finite; leave such points out first");
            items[i] = i;
        }
    });
    Orderer(points).order(items.data(), room.data(), points.count, part_of(run, 0.1, 0.9));
    std::vector<std::int32_t> order(points.count);
    for_blocks(points.count, block, part_of(run, 0.9, 1), [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) order[i] = index_of(items[i]);
    });
    return order;
}

}  // namespace gaussmap
