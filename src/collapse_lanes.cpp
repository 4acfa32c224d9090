// The choice among the kernels of collapse_lanes.h.
#include "collapse_lanes.h"

#include "instruction_sets.h"

namespace gaussmap {

const CollapseLanes& collapse_lanes() {
    return GAUSSMAP_FASTEST(collapse_lanes);
}

}  // namespace gaussmap
