// The choice among the kernels of collapse_lanes.h.
#include "collapse_lanes.h"

namespace gaussmap {

const CollapseLanes& collapse_lanes() {
#ifdef GAUSSMAP_X86
    if (__builtin_cpu_supports("avx2")) return collapse_lanes_avx2;
#endif
    return collapse_lanes_baseline;
}

}  // namespace gaussmap
