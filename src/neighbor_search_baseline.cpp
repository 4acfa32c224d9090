#include "neighbor_search_kernel.h"

namespace gaussmap {

const NearestKernel nearest_kernel_baseline = nearest;

}  // namespace gaussmap
