#include "lane_fits_kernel.h"

namespace gaussmap {

const LaneFitKernel lane_fit_avx2 = kernel;

}  // namespace gaussmap
