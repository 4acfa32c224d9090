#include "vertex_density_kernel.h"

namespace gaussmap {

void fused_kernel_baseline(FusedPass& pass, std::size_t begin, std::size_t end) {
    run<2>(pass, begin, end);
}

}  // namespace gaussmap
