#include "lane_spheres_kernel.h"

namespace gaussmap {

void lane_spheres_baseline(const SphereSample* samples, const LaneBalls& balls, LaneSpheres& spheres) {
    sum_up(samples, balls, spheres);
}

}  // namespace gaussmap
