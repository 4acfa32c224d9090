#include "vertex_density_kernel.h"

namespace gaussmap {

void fused_kernel_avx2(FusedPass& pass, std::size_t begin, std::size_t end) {
    run<4>(pass, begin, end);
}

}  // namespace gaussmap
