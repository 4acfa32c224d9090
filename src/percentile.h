// Percentiles of values that need not be sorted.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace gaussmap {

/// Value at a fraction of the ranks, linear between them. The values are reordered; there must be one.
inline double percentile(std::vector<double>& values, double fraction) {
    const double rank = fraction * static_cast<double>(values.size() - 1);
    const auto below = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), below, values.end());
    const double low = *below;
    if (below + 1 == values.end()) return low;
    return low + (rank - std::floor(rank)) * (*std::min_element(below + 1, values.end()) - low);
}

}  // namespace gaussmap
