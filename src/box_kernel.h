// Distances of boxes, for one instruction set; part of the kernels that include it (registers.h).
#pragma once

#include <cstddef>

#include "registers.h"

namespace gaussmap {
namespace {

struct Box {
    double low[3], high[3];
};

/// Bounds of squared distances between points of one box and points of others: rounding is monotone, so they hold in
/// floating point too.
GAUSSMAP_INLINE Real gap(const Box& box, const double* const (&low)[3], const double* const (&high)[3], std::size_t i) {
    Real sum = Real{};
    for (int a = 0; a < 3; ++a) {
        const Real d = maximum(maximum(load(low[a] + i) - box.high[a], box.low[a] - load(high[a] + i)), Real{});
        sum = a == 0 ? d * d : sum + d * d;
    }
    return sum;
}

}  // namespace
}  // namespace gaussmap
