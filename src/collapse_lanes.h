// Arithmetic of edge collapses on several edges or faces at a time, compiled for one instruction set; all give the same
// bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "local_quadric.h"
#include "ring_mesh.h"

namespace gaussmap {

/// What is left of a quadric beside its shape: − 2 b·x + c, x from the vertex.
struct QuadricRest {
    Vec3 b;
    double c = 0;
};

/// Quadrics about their vertices.
struct VertexQuadrics {
    const Vec3* position;
    const Symmetric* shape;
    const QuadricRest* rest;  ///< null: none
};

struct CollapseLanes {
    /// The least of the sum of two quadrics, of v and of each of w[0 … count), held to the middle between them where it
    /// is flat, and a little for the length.
    void (*costs)(const VertexQuadrics& quadrics, std::int32_t v, const std::int32_t* w, std::size_t count,
                  double* cost);
    /// Whether a face might turn over or become a sliver, when the vertex of the sectors moves from `at` to `p`. Where
    /// none does it never says so.
    bool (*may_spoil)(const Vec3* position, const RingMesh::Sector* sectors, std::size_t count, Vec3 at, Vec3 p);
    /// area n nᵀ of each of `count` faces, 18 numbers: 6 for each corner.
    void (*face_planes)(const Vec3* position, const std::int32_t* corners, std::size_t count, double* planes);
    /// Their sum over the faces of the sectors of a vertex.
    Symmetric (*planes)(const Vec3* position, const RingMesh::Sector* sectors, std::size_t count, Vec3 at);
};
extern const CollapseLanes collapse_lanes_baseline;
extern const CollapseLanes collapse_lanes_avx2;

/// The fastest that this machine runs.
const CollapseLanes& collapse_lanes();

/// How firmly the best position is held to the middle of the edge, where the quadric is flat.
constexpr double collapse_pull = 1e-5;
/// What an edge of length l costs on a plane, as a squared distance over l²: short edges go first there.
constexpr double flat_cost = 1e-9;

}  // namespace gaussmap
