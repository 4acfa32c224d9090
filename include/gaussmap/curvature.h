// Total curvature, k1² + k2², of triangle meshes and point clouds from the variation of the normals.
//
// Method: Crane He Chen, "Estimating Discrete Total Curvature with Per Triangle Normal Variation",
// SIGGRAPH 2023 Talks (arXiv 2305.12653). Equation numbers refer to docs/method.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/normals.h"
#include "gaussmap/types.h"

namespace gaussmap {

/// How curvature is read off a mesh.
enum class Estimator {
    /// Dirichlet energy of the normals (the paper): needs normals, makes `kappa` and densities.
    dirichlet,
    /// Interpolated corrected curvature measures over the one-ring: (Σμ1/Σμ0)² − 2 Σμ2/Σμ0, clamped at 0.
    /// Lachaud, Romon, Thibert, Coeurjolly, "Interpolated corrected curvature measures for polygonal
    /// surfaces", SGP 2020, and the 2022 stability results. `kappa` stays the Dirichlet energy.
    corrected,
};

struct MeshCurvatureOptions {
    Estimator estimator = Estimator::dirichlet;
    /// How vertex normals are made when none are given.
    NormalWeights weights = NormalWeights::max;
    Execution run;
};

struct MeshCurvature {
    std::vector<double> density;       ///< a vertex, 1/length²; NaN where undefined
    std::vector<double> kappa;         ///< a face, no unit (scale invariant); NaN where undefined
    std::vector<double> face_density;  ///< a face, kappa / area, 1/length²; NaN where undefined or of no area
    std::vector<double> normals;       ///< the unit vertex normals used, 3 a vertex; NaN where undefined
    double kappa_sum = 0;              ///< sum of the defined kappa: the integral of k1² + k2² over the surface
    std::size_t undefined = 0;         ///< vertices whose density is NaN (no usable face)
    std::size_t undefined_faces = 0;   ///< faces whose kappa is NaN (a non-finite corner or an undefined normal)
    std::size_t degenerate_faces = 0;  ///< faces of no area: kappa 0, adding nothing to their vertices
    double seconds_normals = 0;
    double seconds_curvature = 0;
};

/// Total curvature of every face and every vertex of a triangle mesh.
///
/// \param vertices  n points; non-finite ones make the faces that use them undefined.
/// \param faces     m index triples; any connectivity (open, non-manifold, duplicated, degenerate).
/// \param normals   n vectors of any positive length, or empty to estimate them (`options.weights`).
/// \throw std::invalid_argument naming the array, index and value: an index outside [0, n),
///        or a number of normals that is neither 0 nor n.
/// Time O(n + m); memory 48 bytes a vertex and 16 a face beyond the input.
/// Source: the paper, eq. (3) of docs/method.md; normals by Max 1999 unless given.
MeshCurvature mesh_curvature(Points vertices, Triangles faces, Points normals = {},
                             const MeshCurvatureOptions& options = {});

/// The fused pass alone: density of every vertex from given *unit* normals, nothing else made and nothing allocated
/// that grows with the mesh on one thread (on more, a byte a vertex).
/// \param density_and_area  room for two values a vertex: its density (NaN where undefined) and the area of its faces
///        added up (0 where undefined). Bits of the densities equal to `mesh_curvature(...).density`.
/// \throw std::invalid_argument as `mesh_curvature`; the contents of density_and_area are then unspecified.
void vertex_density(Points vertices, Triangles faces, Points unit_normals, double* density_and_area,
                    const Execution& run = {});

struct CloudCurvatureOptions {
    /// Neighbours a point, at least 3. Points at one same position count once.
    int k = 20;
    /// How normals are made when none are given.
    CloudNormals method = CloudNormals::jet;
    /// Degree of the fitted jet, 1 to 4 (`CloudNormals::jet`).
    int degree = 4;
    /// How the normals of a neighbourhood are brought to agree. Given normals are never touched:
    /// this is for estimated ones.
    Orientation orientation = Orientation::local;
    Execution run;
};

struct CloudCurvature {
    std::vector<double> density;  ///< a point, 1/length²; NaN where undefined
    std::vector<double> kappa;    ///< a point, sum over its fan, no unit; NaN where undefined
    std::vector<double> normals;  ///< the unit normals used, 3 a point; NaN where undefined
    std::size_t undefined = 0;    ///< points whose density is NaN
    std::size_t duplicates = 0;   ///< points at the position of an earlier one (they share its result)
    std::size_t non_finite = 0;   ///< points with a NaN or infinite coordinate
    std::size_t boundary = 0;     ///< points whose fan is open; copies count once
    std::size_t lowered = 0;      ///< points whose jet had to take a lower degree than asked for; copies count once
    double seconds_neighbors = 0;
    double seconds_normals = 0;
    double seconds_curvature = 0;
};

/// Total curvature of every point of a cloud, from the Delaunay fan in its tangent plane.
///
/// \param points   n points; non-finite ones are undefined and nobody's neighbour.
/// \param normals  n vectors of any positive length, or empty to estimate them.
/// \throw std::invalid_argument: k < 3, a degree outside 1…4, more than 2³¹ points, or a number of
///        normals that is neither 0 nor n.
/// Time O(n k log k) for points on surfaces; memory about 85 bytes a point beyond the input, the result included;
/// 4k + 60 more for `Orientation::mst`.
/// Source: the paper; fan by inversion, eq. (7) of docs/method.md.
CloudCurvature cloud_curvature(Points points, Points normals = {}, const CloudCurvatureOptions& options = {});

}  // namespace gaussmap
