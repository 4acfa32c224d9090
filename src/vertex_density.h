// The fused pass over the triangles of a mesh: kappa and area added up at the vertices, and a triangle if wanted.
#pragma once

#include <cstddef>
#include <cstdint>

#include "first_touch.h"
#include "gaussmap/types.h"

namespace gaussmap {

/// A contribution to a vertex that is added later (first_touch.h).
struct SetAside {
    std::int32_t vertex;
    double kappa, area;
};

/// What one call of a kernel works on.
struct FusedPass {
    const double* xyz;
    const double* normals;      // unit, NaN where undefined
    const std::int32_t* abc;    // checked
    double* sums;               // 2 a vertex: Σ S/2A and Σ 2A
    double* face_kappa;         // a face, or null
    double* face_density;       // a face, or null with face_kappa
    const std::uint8_t* owner;  // null: this chunk owns every vertex
    std::uint8_t chunk;
    mutable SetAside* aside;  // room for 3 a face; moved on
};

/// The loops over the arrays of a mesh, compiled for one instruction set.
struct FusedKernel {
    /// Faces [begin, end) in ascending order.
    void (*faces)(FusedPass&, std::size_t begin, std::size_t end);
    /// The highest of `count` indices, read as unsigned: a negative one is beyond any number of vertices.
    std::uint32_t (*highest)(const std::int32_t* indices, std::size_t count);
    /// Sums of `count` vertices become density (NaN where undefined) and area, in place.
    void (*divide)(double* sums, std::size_t count);
};
extern const FusedKernel fused_kernel_baseline;
extern const FusedKernel fused_kernel_avx2;

/// Sums for all vertices (2 each, room given), and kappa and density of every face unless null.
/// \throw std::invalid_argument at an index outside the vertices.
void fused_pass(Points vertices, Triangles faces, const FaceChunks& chunks, Points unit_normals, double* sums,
                double* face_kappa, double* face_density, const Execution& run);

/// The sums of the vertices become density (NaN where undefined) and area, in place.
void divide_sums(double* sums, std::size_t vertices, const Execution& run);

}  // namespace gaussmap
