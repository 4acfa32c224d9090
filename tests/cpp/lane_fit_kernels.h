// The fits of lane_fits.h for every instruction set that this machine runs.
#pragma once

#include <vector>

#include "../../src/lane_fits.h"

inline std::vector<const gaussmap::LaneFitKernel*> lane_fit_kernels() {
    std::vector<const gaussmap::LaneFitKernel*> found = {&gaussmap::lane_fit_baseline};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) found.push_back(&gaussmap::lane_fit_avx2);
#endif
    return found;
}
