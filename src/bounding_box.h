// The axis-parallel box of points.
#pragma once

#include <algorithm>
#include <limits>

#include "vec.h"

namespace gaussmap {

struct BoundingBox {
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    Vec3 low = {infinity, infinity, infinity}, high = -low;

    void include(Vec3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    bool empty() const { return !(low.x <= high.x); }
    /// 0 for no points.
    double diagonal() const { return empty() ? 0 : length(high - low); }
};

}  // namespace gaussmap
