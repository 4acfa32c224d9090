// The choice among the kernels of cloud_kernel.h.
#include "cloud_kernel.h"

#include "instruction_sets.h"

namespace gaussmap {

const CloudKernel& best_cloud_kernel() {
    return GAUSSMAP_FASTEST(cloud_kernel);
}

}  // namespace gaussmap
