// Unit normals of meshes and clouds, and their orientation.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/neighbors.h"
#include "gaussmap/types.h"

namespace gaussmap {

/// What a face's normal weighs at its vertices.
enum class NormalWeights {
    /// sin α / (|e1| |e2|), exact on every triangulated sphere. Max, "Weights for Computing Vertex
    /// Normals from Facet Normals", J. Graphics Tools 4(2), 1999.
    max,
    /// The angle at the vertex. Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998.
    angle,
    /// The area of the face (the paper's program; does not converge on irregular meshes).
    area,
};

/// How the normal of a cloud point is fitted to its neighbours.
enum class CloudNormals {
    pca,  ///< smallest principal direction of the neighbours. Hoppe et al., "Surface Reconstruction from Unorganized
          ///< Points", 1992
    weighted_pca,  ///< the same, neighbours weighing (1 − (d/h)²)² by their distance d
    jet,  ///< normal of a fitted polynomial height field. Cazals and Pouget, "Estimating Differential Quantities Using
          ///< Polynomial Fitting of Osculating Jets", 2005
};

/// How the signs of estimated normals are brought to agree.
enum class Orientation {
    local,  ///< inside each fan, to the centre's normal: no global sign is sought, every point stands alone
    mst,   ///< along a minimum spanning tree of 1 − |n·n'| (Hoppe et al. 1992), outward at the highest point of each
           ///< part
    none,  ///< as the fit left them
};

/// Unit vertex normals of a triangle mesh: 3 values a vertex, NaN where no face defines one
/// (isolated, only degenerate or non-finite faces, or faces that cancel exactly).
/// \throw std::invalid_argument on an index outside [0, vertices.count).
/// Time O(n + m). The same bits for any number of threads.
std::vector<double> mesh_normals(Points vertices, Triangles faces, NormalWeights weights = NormalWeights::max,
                                 const Execution& run = {});

struct CloudNormalsOptions {
    CloudNormals method = CloudNormals::jet;
    int degree = 4;  ///< of the jet, 1 to 4; lowered where the neighbours do not determine it
    Execution run;
};

struct CloudNormalsResult {
    std::vector<double> normals;  ///< 3 a point, unit, of arbitrary sign; NaN where undefined
    std::size_t undefined = 0;    ///< points whose neighbours span no plane (fewer than 2, or all on a line)
    std::size_t lowered = 0;      ///< points whose jet took a lower degree than asked for
};

/// Unit normals of a cloud, unoriented, from the given neighbours (which need not include the point).
/// \param points     n finite points.
/// \param neighbors  their nearest neighbours, as `nearest_neighbors` gives them.
/// \throw std::invalid_argument on a degree outside 1…4 or neighbours of another number of points.
/// Time O(n k m²), m the number of coefficients (2, 5, 9, 14 for degrees 1…4).
CloudNormalsResult cloud_normals(Points points, const Neighbors& neighbors, const CloudNormalsOptions& options = {});

/// Flip normals in place so that neighbours agree, along the minimum spanning tree of the symmetrised
/// neighbour graph, weight 1 − |n·n'|; each connected part starts with its highest point looking up (+z).
/// NaN normals are left as they are and join nothing. Ties are broken by index.
/// Time O(n k log n), memory O(n k). Source: Hoppe et al. 1992, section 3.3.
void orient_normals(Points points, const Neighbors& neighbors, std::vector<double>& normals, const Execution& run = {});

}  // namespace gaussmap
