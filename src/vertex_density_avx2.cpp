#include "vertex_density_kernel.h"

namespace gaussmap {

const FusedKernel fused_kernel_avx2 = {run<4>, highest, divide};

}  // namespace gaussmap
