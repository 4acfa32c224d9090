#include "max_normals_kernel.h"

namespace gaussmap {

const MaxNormals max_normals_baseline = run<2>;

}  // namespace gaussmap
