// The choice among the kernels of lane_fits.h.
#include "lane_fits.h"

#include "instruction_sets.h"

namespace gaussmap {

const LaneFitKernel& best_lane_fit() {
    return GAUSSMAP_FASTEST(lane_fit);
}

}  // namespace gaussmap
