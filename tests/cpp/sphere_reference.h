// Which samples of a surface count for the sphere of a place, told plainly.
#pragma once

#include <cmath>

#include "../../src/lane_spheres.h"

namespace support {

/// The normal that a circle through a place and a sample at the difference d from it has at the sample.
inline gaussmap::Vec3 expected_normal(gaussmap::Vec3 d, gaussmap::Vec3 own) {
    return own - (2 * dot(d, own) / (squared(d) + gaussmap::near_by)) * d;
}

/// Add a sample at the difference d from the place, in units of the window, if it counts; whether it does.
/// \param own  normal of the place, and `normal` that of the sample, of either side.
inline bool add_if_seen(gaussmap::SphereSums& sums, gaussmap::Vec3 d, gaussmap::Vec3 normal, gaussmap::Vec3 own,
                        double weight) {
    using namespace gaussmap;
    const double expected = dot(normal, expected_normal(d, own));
    const Vec3 turned = (expected < 0 ? -1.0 : 1.0) * normal;
    if (!(std::abs(expected) >= as_expected) || !(dot(turned, own) >= same_half) || !(squared(d) < 1)) return false;
    sums.add(d, turned, weight);
    return true;
}

}  // namespace support
