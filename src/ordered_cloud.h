// The points of a cloud that work is done on: finite, each position once, near ones near each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// A point at the position of an earlier one, by input indices.
struct Copy {
    std::int32_t index, first;
};

struct OrderedCloud {
    std::vector<double> points;        ///< along a space-filling curve, 3 values each
    std::vector<std::int32_t> source;  ///< place in that order → input index, that of the first holder of the position
    std::vector<Copy> copies;          ///< the finite points that are nobody's source
    std::size_t non_finite = 0;

    std::size_t count() const { return source.size(); }
};

/// The order depends on the positions alone, neither on copies nor on what is not finite.
/// \throw std::invalid_argument on more than 2³¹ − 1 points. Time O(n); memory 28 bytes a point, 24 while it works.
OrderedCloud ordered_cloud(Points points, const Execution& run);

}  // namespace gaussmap
