#include "neighbor_search_kernel.h"

namespace gaussmap {

const NearestKernel nearest_kernel_avx2 = nearest;

}  // namespace gaussmap
