#include "fan_energy.h"

#include <algorithm>

#include "vec.h"

namespace gaussmap {
namespace {

/// The corners in a row with a triangle between each two: of a closed fan the last comes first, too.
std::size_t row_length(const Chains::One& fan) {
    return fan.size + (fan.closed ? 1 : 0);
}

/// Corners [begin, begin + count) of that row.
void gather(const OrderedCloud& cloud, const double* normals, const Chains& chains, const Chains::One& fan,
            std::size_t begin, std::size_t count, std::size_t l, LaneStrips& strips) {
    const std::int32_t* const chain = chains.begin(fan);
    const Vec3 origin = cloud[static_cast<std::size_t>(fan.point)];
    for (std::size_t c = 0; c < count; ++c) {
        const std::size_t place = begin + c + (fan.closed ? fan.size - 1 : 0);
        const auto corner = static_cast<std::size_t>(chain[place < fan.size ? place : place - fan.size]);
        const Vec3 d = fan.scale * (cloud[corner] - origin), n = load(normals + 3 * corner);
        strips.d[c][0][l] = d.x, strips.d[c][1][l] = d.y, strips.d[c][2][l] = d.z;
        strips.n[c][0][l] = n.x, strips.n[c][1][l] = n.y, strips.n[c][2][l] = n.z;
    }
    strips.count[l] = static_cast<std::int32_t>(count);
}

}  // namespace

void fan_energies(const OrderedCloud& cloud, const FanNormals& normals, const Chains& chains, std::size_t first,
                  LaneStrips& room, LaneEnergies& energies) {
    constexpr std::size_t most = LaneStrips::most_others;
    const std::size_t lanes_used = std::min<std::size_t>(fit_lanes, chains.fans.size() - first);
    energies = {};
    std::size_t longest = 0;
    for (std::size_t l = 0; l < lanes_used; ++l) {
        const Chains::One& fan = chains.fans[first + l];
        const Vec3 n = load(normals.unit + 3 * static_cast<std::size_t>(fan.point));
        room.normal[0][l] = n.x, room.normal[1][l] = n.y, room.normal[2][l] = n.z;
        longest = std::max(longest, row_length(fan));
    }
    // Long rows go in pieces that share an end; nearly all are shorter than one.
    for (std::size_t begin = 0; begin + 1 < longest; begin += most - 1) {
        std::fill_n(room.count, fit_lanes, 0);
        for (std::size_t l = 0; l < lanes_used; ++l) {
            const Chains::One& fan = chains.fans[first + l];
            const std::size_t length = row_length(fan);
            if (begin + 1 < length)
                gather(cloud, normals.unit, chains, fan, begin, std::min(length - begin, most), l, room);
        }
        best_cloud_kernel().energies(room, normals.align, energies);
    }
}

}  // namespace gaussmap
