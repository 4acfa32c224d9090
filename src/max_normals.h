// What triangles give to the normals of their corners by the weights of Max, several triangles at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gaussmap {

/// The weighted normals that the triangles from `abc` on give to their three corners, 9 numbers a triangle; 0 from
/// triangles without area and those that are not finite. Compiled for one instruction set; all give the same bits.
using MaxNormals = void (*)(const double* xyz, const std::int32_t* abc, std::size_t count, double* corners);
extern const MaxNormals max_normals_baseline;
extern const MaxNormals max_normals_avx2;

}  // namespace gaussmap
