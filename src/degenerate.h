// When a triangle has no area.
#pragma once

namespace gaussmap {

/// (4 ε)² with ε = 2⁻⁵²: the square of the relative size below which |e1 × e2| is rounding error of the products in it.
constexpr double no_area_ratio = 16 * 0x1p-104;

/// Collinear to rounding, or a point: 2A ≤ 4ε · ½ Σ |e|².
/// `cross_squared` is |e1 × e2|² = (2A)², `half_squares` half the sum of the three squared edges, which is also the sum
/// of the three dot products of the edges at the corners.
inline bool no_area(double cross_squared, double half_squares) {
    return cross_squared <= no_area_ratio * (half_squares * half_squares);
}

}  // namespace gaussmap
