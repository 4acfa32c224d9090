// Total curvature, k1² + k2², of triangle meshes from the variation of the normals, and of point clouds from surfaces
// fitted to them or from the variation of the normals.
//
// Method of the latter: Crane He Chen, "Estimating Discrete Total Curvature with Per Triangle Normal Variation",
// SIGGRAPH 2023 Talks (arXiv 2305.12653). Equation numbers refer to docs/method.md.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "gaussmap/normals.h"
#include "gaussmap/types.h"

namespace gaussmap {

/// How curvature is read off a mesh or a cloud.
enum class Estimator {
    /// Chooses for each vertex or point from the data, without a parameter; what it took is in `choice`.
    automatic,
    /// Dirichlet energy of the normals (the paper): needs normals, makes `kappa` and densities.
    dirichlet,
    /// Meshes. Interpolated corrected curvature measures over the one-ring: (Σμ1/Σμ0)² − 2 Σμ2/Σμ0, clamped at 0.
    /// Lachaud, Romon, Thibert, Coeurjolly, "Interpolated corrected curvature measures for polygonal
    /// surfaces", SGP 2020, and the 2022 stability results. `kappa` stays the Dirichlet energy.
    corrected,
    /// Least squares of the normals of the k nearest neighbours, by a quadratic in the tangent plane: its linear part
    /// is
    /// the shape operator. Exact on spheres and cylinders with exact normals. Makes no `kappa` of clouds.
    regression,
    /// Curvature of a polynomial of `degree` 2 to 4 through the point, fitted to the k ≥ 5 nearest neighbours. Needs no
    /// normals, and makes its own; makes no `kappa` of clouds.
    /// Cazals and Pouget, "Estimating differential quantities using polynomial fitting of osculating jets", CAGD 2005.
    jet,
};

/// "auto", "dirichlet", "corrected", "regression", "jet".
const char* estimator_name(Estimator estimator);

/// What a value of `choice` stands for, in a word or two, with the neighbours fitted to: "quartic 24", "mean quadric
/// 54"; "none" for 0, where nothing was defined. \throw std::invalid_argument on a value that is never written.
const char* choice_name(std::uint8_t choice);

/// Principal curvatures and directions: the shape operator dn/dx of each element, diagonalised. k1 ≥ k2, and a sphere
/// with outward normals has k1 = k2 = 1/r > 0. The sign follows the normals, so it means something where these are
/// oriented; turned round they give −k2, −k1.
struct PrincipalCurvatures {
    std::vector<double> k1, k2;     ///< one each an element, 1/length; NaN where undefined
    std::vector<double> direction;  ///< unit direction of k1, 3 an element, of its two signs the one that looks up (z >
                                    ///< 0, else y, else x); any tangent where k1 = k2. normal × direction is that of k2
};

/// H = (k1 + k2) / 2, 1/length: 1/r on a sphere with outward normals, 0 on a minimal surface.
inline double mean_curvature(double k1, double k2) {
    return 0.5 * (k1 + k2);
}
/// K = k1 k2, 1/length²: positive on caps and cups, negative on saddles, whichever way the normals look.
inline double gaussian_curvature(double k1, double k2) {
    return k1 * k2;
}
/// 2/π · atan((k1 + k2) / (k1 − k2)) in [−1, 1] for k1 ≥ k2, no unit: 1 a cap (of a sphere with outward normals), ½ a
/// ridge, 0 a symmetric saddle, −½ a rut, −1 a cup; NaN on a flat point, which has no shape.
/// Koenderink and van Doorn, "Surface shape and curvature scales", Image and Vision Computing 10(8), 1992 (up to the
/// sign, which follows the normal there too).
inline double shape_index(double k1, double k2) {
    return 2 / std::numbers::pi * std::atan((k1 + k2) / (k1 - k2));
}
/// √((k1² + k2²) / 2), 1/length: how strongly the surface bends, 1/r on a sphere. Koenderink and van Doorn 1992.
inline double curvedness(double k1, double k2) {
    return std::sqrt(0.5 * (k1 * k1 + k2 * k2));
}

struct MeshCurvatureOptions {
    Estimator estimator = Estimator::dirichlet;
    /// How vertex normals are made when none are given. To fits they tell the sides; `regression` is then on fitted
    /// ones.
    NormalWeights weights = NormalWeights::max;
    int k = 20;  ///< `jet` and `regression`: neighbours a vertex, at least 3 (5 for jets), from whole rings of edges
    int degree = 4;           ///< of the jet, 2 to 4 (`jet`), 1 to 4 (of the normals that `regression` fits)
    bool tensor = false;      ///< make vertex_tensor and face_tensor
    bool confidence = false;  ///< make `error`; not for dirichlet and corrected, which have no residuals
    Execution run;
};

struct MeshCurvature {
    std::vector<double> density;        ///< a vertex, 1/length²; NaN where undefined
    std::vector<double> kappa;          ///< a face, no unit (scale invariant); NaN where undefined
    std::vector<double> face_density;   ///< a face, kappa / area, 1/length²; NaN where undefined or of no area
    std::vector<double> normals;        ///< the unit vertex normals used or fitted, 3 a vertex; NaN where undefined
    PrincipalCurvatures vertex_tensor;  ///< a vertex; empty unless asked for
    PrincipalCurvatures face_tensor;    ///< a face, in its plane, from its three normals; empty unless asked for
    std::vector<double> error;  ///< a vertex, the standard error of its density, 1/length²; empty unless asked for
    std::vector<std::uint8_t> choice;  ///< a vertex, what `automatic` took (`choice_name`); empty for other estimators
    double kappa_sum = 0;              ///< sum of the defined kappa: the integral of k1² + k2² over the surface
    std::size_t undefined = 0;  ///< vertices whose density is NaN (no usable face, or too few neighbours to fit to)
    std::size_t lowered = 0;    ///< vertices with too few neighbours for the jet asked for, or a quartic
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
///        or a number of normals that is neither 0 nor n; k < 3 (5 for jets) or a degree outside 1…4 (2…4 for jets),
///        where they are used; confidence of an estimator that has none.
/// Time O(n + m), fits O(n k); memory 48 bytes a vertex and 16 a face beyond the input; with the tensor 72 and 40 more.
/// Source: the paper, eq. (3) of docs/method.md; normals by Max 1999 unless given; the shape operator by eq. (9), (10);
/// fits by eq. (13) to (18).
MeshCurvature mesh_curvature(Points vertices, Triangles faces, Points normals = {},
                             const MeshCurvatureOptions& options = {});

/// The fused pass alone: density of every vertex from given *unit* normals, nothing else made and nothing allocated
/// that grows with the mesh on one thread (on more, a byte a vertex).
/// \param density_and_area  room for two values a vertex: its density (NaN where undefined) and the area of its faces
///        added up (0 where undefined). Bits of the densities equal to `mesh_curvature(...).density`.
/// \throw std::invalid_argument as `mesh_curvature`; the contents of density_and_area are then unspecified.
void vertex_density(Points vertices, Triangles faces, Points unit_normals, double* density_and_area,
                    const Execution& run = {});

/// All but the estimator, `tensor`, `confidence` and `run` is nothing to `automatic`.
struct CloudCurvatureOptions {
    Estimator estimator = Estimator::automatic;
    /// Neighbours a point, at least 3. Points at one same position count once.
    int k = 20;
    /// How normals are made when none are given.
    CloudNormals method = CloudNormals::jet;
    /// Degree of the fitted jet, 1 to 4 (`CloudNormals::jet`), 2 to 4 (`Estimator::jet`).
    int degree = 4;
    /// How the normals of a neighbourhood are brought to agree. Given normals are never touched:
    /// this is for estimated ones.
    Orientation orientation = Orientation::local;
    bool tensor = false;      ///< make `tensor` of the result
    bool confidence = false;  ///< make `error`; not for dirichlet, which has no residuals
    Execution run;
};

struct CloudCurvature {
    std::vector<double> density;  ///< a point, 1/length²; NaN where undefined
    std::vector<double> kappa;    ///< a point, sum over its fan, no unit; NaN where undefined, and without fans
    std::vector<double> normals;  ///< the unit normals used or fitted, 3 a point; NaN where undefined
    PrincipalCurvatures tensor;   ///< a point, signed by its own normal; empty unless asked for
    std::vector<double> error;    ///< a point, the standard error of its density, 1/length²; empty unless asked for
    std::vector<std::uint8_t> choice;  ///< a point, what `automatic` took (`choice_name`); empty for other estimators
    std::size_t undefined = 0;         ///< points whose density is NaN
    std::size_t duplicates = 0;        ///< points at the position of an earlier one (they share its result)
    std::size_t non_finite = 0;        ///< points with a NaN or infinite coordinate
    std::size_t boundary = 0;          ///< points whose fan is open; copies count once; 0 without fans
    std::size_t lowered = 0;  ///< points with too few neighbours for the jet asked for, or a quartic; copies count once
    double seconds_neighbors = 0;
    double seconds_normals = 0;
    double seconds_curvature = 0;
};

/// Total curvature of every point of a cloud: `automatic` from surfaces fitted to the points, where given normals tell
/// the signs alone; `dirichlet` from the normals, by the Delaunay fan in each point's tangent plane; `jet` and
/// `regression` from k neighbours.
///
/// \param points   n points; non-finite ones are undefined and nobody's neighbour.
/// \param normals  n vectors of any positive length, or empty to estimate them.
/// \throw std::invalid_argument: k < 3 (5 for jets), a degree outside 1…4 (2…4 for the estimator `jet`), more than 2³¹
/// points, a number of
///        normals that is neither 0 nor n, the estimator `corrected`, or confidence of an estimator that has none.
/// Time O(n) fits for `automatic`, more where there is noise; else O(n k log k) for points on surfaces, memory about 85
/// bytes a point beyond the input, the result included; 4k + 60 more for `Orientation::mst`, 40 more for the tensor.
/// Source: the paper; fan by inversion, eq. (7) of docs/method.md; jets and regression by eq. (13) to (15), `automatic`
/// by (16) to (18).
CloudCurvature cloud_curvature(Points points, Points normals = {}, const CloudCurvatureOptions& options = {});

}  // namespace gaussmap
