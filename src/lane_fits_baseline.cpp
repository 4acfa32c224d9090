#include "lane_fits_kernel.h"

namespace gaussmap {

const LaneFitKernel lane_fit_baseline = kernel;

}  // namespace gaussmap
