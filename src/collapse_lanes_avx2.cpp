#include "collapse_lanes_kernel.h"

namespace gaussmap {

const CollapseLanes collapse_lanes_avx2 = {CollapseKernel<4>::costs, CollapseKernel<4>::may_spoil,
                                           CollapseKernel<4>::face_planes, CollapseKernel<4>::planes};

}  // namespace gaussmap
