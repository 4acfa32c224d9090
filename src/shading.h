// Light on a surface that is there to show its colours: bright where it faces the eye, never black.
#pragma once

#include <algorithm>
#include <cmath>

#include "colormap.h"
#include "vec.h"

namespace gaussmap {

/// `normal` is unit in the picture's axes (x right, y down, z toward the eye) with z ≥ 0, `open` the part of the light
/// that gets between what is around, 0 to 1. A surface square to the eye shows the colour itself, and the light, which
/// comes from above the eye and to its left, has its brightest spot beside it.
inline LinearRgb shade(LinearRgb color, Vec3 normal, double open) {
    constexpr double ambient = 0.22;
    const double diffuse = std::max(0.0, -0.26 * normal.x - 0.42 * normal.y + (1 - ambient) * normal.z);
    const double light = (ambient + diffuse) * open;
    // A soft shine, halfway between light and eye, gone where the surface is square to the eye.
    const double half = std::max(0.0, -0.15 * normal.x - 0.24 * normal.y + 0.959 * normal.z);
    const double square = half * half, fourth = square * square, shine = fourth * fourth * fourth * fourth;
    const double white = 0.07 * shine * shine * open * (1 - normal.z * normal.z) * 4;
    const auto lit = [&](float c) { return static_cast<float>(std::min(1.0, c * light + white)); };
    return {lit(color.r), lit(color.g), lit(color.b)};
}

}  // namespace gaussmap
