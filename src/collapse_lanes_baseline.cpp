#include "collapse_lanes_kernel.h"

namespace gaussmap {

const CollapseLanes collapse_lanes_baseline = {CollapseKernel<2>::costs, CollapseKernel<2>::may_spoil,
                                               CollapseKernel<2>::face_planes, CollapseKernel<2>::planes};

}  // namespace gaussmap
