#include "vertex_density_kernel.h"

namespace gaussmap {

const FusedKernel fused_kernel_baseline = {run<2>, highest, divide};

}  // namespace gaussmap
