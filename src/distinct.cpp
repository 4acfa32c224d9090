// A cloud without repetitions, by one pass over a hash table of positions (open addressing, linear probing).
#include <bit>

#include "check_cloud.h"
#include "gaussmap/neighbors.h"
#include "vec.h"

namespace gaussmap {
namespace {

/// Mixes the bits of the three coordinates, −0 read as +0. The finaliser is that of MurmurHash3 (Appleby).
std::uint64_t hash(Vec3 p) {
    std::uint64_t h = 0;
    for (const double value : {p.x, p.y, p.z}) {
        h ^= std::bit_cast<std::uint64_t>(value + 0.0);
        h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdu;
        h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53u;
        h ^= h >> 33;
    }
    return h;
}

}  // namespace

DistinctPoints distinct_points(Points points) {
    check_countable(points);
    DistinctPoints distinct;
    distinct.target.resize(points.count);
    distinct.points.reserve(3 * points.count);
    distinct.source.reserve(points.count);
    std::vector<std::int32_t> table(std::bit_ceil(2 * points.count + 1), -1);  // positions of distinct.source
    const std::size_t mask = table.size() - 1;
    for (std::size_t i = 0; i < points.count; ++i) {
        const Vec3 p = load(points[i]);
        if (!finite(p)) {
            distinct.target[i] = -1;
            ++distinct.non_finite;
            continue;
        }
        std::size_t slot = hash(p) & mask;
        for (; table[slot] >= 0; slot = (slot + 1) & mask) {
            const Vec3 q = load(distinct.points.data() + 3 * static_cast<std::size_t>(table[slot]));
            if (p.x == q.x && p.y == q.y && p.z == q.z) break;
        }
        if (table[slot] >= 0) {
            ++distinct.duplicates;
        } else {
            table[slot] = static_cast<std::int32_t>(distinct.source.size());
            distinct.source.push_back(static_cast<std::int32_t>(i));
            distinct.points.insert(distinct.points.end(), {p.x, p.y, p.z});
        }
        distinct.target[i] = table[slot];
    }
    return distinct;
}

}  // namespace gaussmap
