// When a triangle has no area.
#pragma once

namespace gaussmap {

/// (4 ε)² with ε = 2⁻⁵²: the square of the relative size below which |e1 × e2| is rounding error of the products in it.
constexpr double no_area_ratio = 16 * 0x1p-104;

/// `cross_squared` is |e1 × e2|², `longest_squared` the square of the longest edge: collinear to rounding, or a point.
inline bool no_area(double cross_squared, double longest_squared) {
    return cross_squared <= no_area_ratio * (longest_squared * longest_squared);
}

}  // namespace gaussmap
