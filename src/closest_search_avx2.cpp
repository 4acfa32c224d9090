#include "closest_search_kernel.h"

namespace gaussmap {

const ClosestKernel closest_kernel_avx2 = closest;

}  // namespace gaussmap
