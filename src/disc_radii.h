// How large the points of a cloud are drawn.
#pragma once

#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// The discs of a cloud: as far as the sixth neighbour, so that neighbours overlap; not above three times the median,
/// which keeps stray points small. Points at the position of an earlier one, or not finite, have none (0).
std::vector<double> disc_radii(Points points, const Execution& run);

}  // namespace gaussmap
