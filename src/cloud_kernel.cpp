// The choice among the kernels of cloud_kernel.h.
#include "cloud_kernel.h"

namespace gaussmap {

const CloudKernel& best_cloud_kernel() {
#ifdef GAUSSMAP_X86
    if (__builtin_cpu_supports("avx2")) return cloud_kernel_avx2;
#endif
    return cloud_kernel_baseline;
}

}  // namespace gaussmap
