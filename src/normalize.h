// Vectors made unit.
#pragma once

#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// Every three values scaled to length 1; NaN where they have no direction (zero, infinite or NaN).
void normalize(std::vector<double>& vectors, const Execution& run);

}  // namespace gaussmap
