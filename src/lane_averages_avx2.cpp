#include "lane_averages_kernel.h"

namespace gaussmap {

void lane_averages_avx2(const SurfaceSample* samples, const LaneCentres& centres, LaneAverages (&windows)[2]) {
    average(samples, centres, windows);
}

}  // namespace gaussmap
