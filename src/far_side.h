// What a window has met, by the residuals of its quadric: more of the shape than a quadric follows, its far side, a
// hole.
#pragma once

#include <algorithm>

#include "shape_tensor.h"

namespace gaussmap {

/// Are residuals (variances, on the lowest level) that large beside the squared radius that the window has met the far
/// side? 0.01 of it they are on a thick torus under little noise, 0.02 where a window holds a wave, and 0.07 where it
/// holds all of a tube.
constexpr bool meets_far_side(float residual, float noise, float size) {
    constexpr float as_wide_as_shape = 0.015F;
    return residual - noise > as_wide_as_shape * size * size;
}

/// k1 k2 / (k1² + k2²) of a shape operator, from -½ to ½; NaN of 0.
inline float saddle(const Symmetric3& shape) {
    const double trace = shape.xx + shape.yy + shape.zz, square = squared_norm(shape);
    return static_cast<float>(0.5 * (trace * trace - square) / square);
}

/// Where all nearby is a saddle, by the average of the above, the far side is that of a hole. Beyond that of a tube
/// there are other sheets.
constexpr bool is_hole(float saddle) {
    return saddle < -0.3F;
}

/// Is all that residuals exceed the noise by due to the bend of a shape of this density? Of an arc of curvature κ a
/// quadric leaves a part of κ³h⁴, squared a part of h² (h²ρ)³: 0.002 at the inner rim of a thick torus, above 0.005
/// where windows hold waves. Until windows hold all of a tube, or most of a hole.
constexpr bool is_bend(float residual, float noise, float size, float density, bool hole) {
    constexpr float left = 0.005F, most = 0.06F, most_of_hole = 0.2F;
    const float size2 = size * size, bend = size2 * density;
    return residual - noise <= std::min(hole ? most_of_hole : most, left * bend * bend * bend) * size2;
}

}  // namespace gaussmap
