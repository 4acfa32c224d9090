// The choice among the kernels of lane_fits.h.
#include "lane_fits.h"

namespace gaussmap {

const LaneFitKernel& best_lane_fit() {
#ifdef GAUSSMAP_X86
    if (__builtin_cpu_supports("avx2")) return lane_fit_avx2;
#endif
    return lane_fit_baseline;
}

}  // namespace gaussmap
