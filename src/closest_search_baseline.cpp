#include "closest_search_kernel.h"

namespace gaussmap {

const ClosestKernel closest_kernel_baseline = closest;

}  // namespace gaussmap
