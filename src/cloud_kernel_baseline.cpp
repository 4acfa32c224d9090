#include "energy_kernel.h"
#include "fan_kernel.h"
#include "principal_kernel.h"

namespace gaussmap {

const CloudKernel cloud_kernel_baseline = {principal, closed_fans, energies};

}  // namespace gaussmap
