#include "max_normals_kernel.h"

namespace gaussmap {

const MaxNormals max_normals_avx2 = run<4>;

}  // namespace gaussmap
