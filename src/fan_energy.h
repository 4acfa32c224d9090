// The energies of the normals over fans, four fans side by side.
#pragma once

#include <cstdint>
#include <vector>

#include "cloud_kernel.h"
#include "ordered_cloud.h"

namespace gaussmap {

/// The fans of some points.
struct Chains {
    struct One {
        double scale;  ///< of lengths: brings the corners to a size near 1
        std::int32_t point;
        std::uint32_t begin, size;
        bool closed;
    };
    std::vector<One> fans;
    std::vector<std::int32_t> corners;

    const std::int32_t* begin(const One& fan) const { return corners.data() + fan.begin; }
    /// \param chain  places of the corners in `row`.
    void add(const One& fan, const std::int32_t* chain, const std::int32_t* row) {
        fans.push_back(fan);
        fans.back().begin = static_cast<std::uint32_t>(corners.size());
        for (std::uint32_t c = 0; c < fan.size; ++c) corners.push_back(row[chain[c]]);
    }
};

/// Unit normals of the points of a cloud; with `align`, those that look away from a fan's centre are turned round.
struct FanNormals {
    const double* unit;
    bool align;
};

/// kappa, eq. (3) of docs/method.md, and area of up to `fit_lanes` fans from `first` on, the area in units of the
/// scaled lengths; triangles that have no area or an undefined normal add nothing.
void fan_energies(const OrderedCloud& cloud, const FanNormals& normals, const Chains& chains, std::size_t first,
                  LaneStrips& room, LaneEnergies& energies);

}  // namespace gaussmap
