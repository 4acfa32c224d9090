// Decimation: fewer triangles for the same surface, its features kept.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

enum class DecimationMethod {
    /// Collapses by the quadrics of the surface as it is; then the vertices that are left are fitted to samples of the
    /// original, sides are flipped, and the greatest distances are brought down one by one. Section "Decimation" of
    /// docs/method.md.
    best,
    /// Quadric error metric, optimal placement; quadrics weigh by the total curvature (the paper's second pipeline).
    /// Without weights: Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics", SIGGRAPH 1997.
    qem,
    /// Shortest edge first, to its midpoint; lengths weigh by the total curvature (the paper's first pipeline).
    edge,
};

/// Which distance `DecimationMethod::best` makes small: the root mean square, the maximum, or both.
enum class DecimationObjective { both, rms, max };

struct DecimateOptions {
    /// Stop at this many faces, or one or two less. Where no valid step is left above, `Decimation::stop` says so.
    std::size_t faces = 0;
    /// Above 0: instead, as few faces as are found whose two-sided Hausdorff distance is at most this part of the
    /// diagonal of the box, proven by `hausdorff_bound`. Costs about ten decimations.
    double error = 0;
    DecimationMethod method = DecimationMethod::best;
    DecimationObjective objective = DecimationObjective::both;
    /// Costs weigh by a vertex's total curvature over the median, to the power of ½ (`best`: ¼). False: by 1
    /// everywhere.
    bool weights = true;
    /// Of `best` the collapses alone, by quadrics that remember the first surface: many times faster.
    bool fast = false;
    bool preserve_boundary = false;  ///< borders hold a thousand times firmer than the surface, instead of as firmly
    bool lock_border = false;  ///< no vertex of a border, seam, feature or side that is not manifold moves or goes
    /// Sides whose faces' normals differ by more than this, in degrees, are features, along which collapses run.
    double feature_angle = 180;
    bool allow_topology = false;  ///< holes and slits may close
    bool measure = false;         ///< find the distances of the result from the input
    bool sources = false;         ///< make the sources of the result, by which values are carried over
    /// A byte a corner, 3 a face, or empty: not 0 where the side opposite to the corner is a seam, kept as borders are.
    std::vector<std::uint8_t> seams;
    Execution run;
};

/// Why no further step was made.
enum class DecimationStop {
    target,    ///< the number of faces, or the error, was reached
    validity,  ///< every collapse left would fold the surface, change its topology, or move what must stay
};

/// A point of the input's surface: a face and the weights of its corners. Face −1: none.
struct SurfacePoint {
    std::int32_t face = -1;
    std::array<double, 3> weights = {0, 0, 0};
};

struct Decimation {
    std::vector<double> vertices;             ///< 3 a vertex
    std::vector<std::int32_t> faces;          ///< 3 a face
    std::vector<std::int32_t> face_source;    ///< a face: the input's face that it descends from
    std::vector<SurfacePoint> vertex_source;  ///< a vertex: the nearest point of the input, without a fit a near
                                              ///< one; empty unless asked for
    std::vector<SurfacePoint>
        corner_source;  ///< 3 a face: the same on the face's side of the seams; empty without seams
    DecimationStop stop = DecimationStop::target;
    double error_bound = 0;      ///< proven, over the diagonal, where an error was asked for
    double max_error = 0;        ///< over the diagonal, both ways, from 100,000 samples, where it was to be measured
    double rms_error = 0;        ///< … the root mean square
    std::size_t degenerate = 0;  ///< faces of the input left out: a corner repeated
    std::size_t non_finite = 0;  ///< faces of the input left out: a corner that is not finite
    std::size_t refused_locked = 0;    ///< where stopped by validity, sides that could not collapse: between vertices
                                       ///< that must stay, or across a border, seam or feature
    std::size_t refused_topology = 0;  ///< … that would have changed the topology
    std::size_t refused_folding = 0;   ///< … that would have folded the surface or made a sliver
    double seconds_collapse = 0, seconds_fit = 0, seconds_measure = 0;
};

/// Fewer triangles for the same surface.
///
/// What comes out is as valid as what went in: no face turns over in a step, no side gets a further face, parts,
/// handles and holes are kept. Borders, seams, features and sides that are not manifold are curves along which
/// collapses run; where such curves meet, end, or touch, vertices stay. The unit of length does not matter, nor does
/// the order of faces and vertices (up to the numbers in the result).
///
/// \param vertices  n points; those not finite, and the faces that use them, are left out.
/// \param faces     m index triples; any connectivity (open, non-manifold, duplicated, degenerate).
/// \throw std::invalid_argument: an index outside [0, n), a number of seams that is neither 0 nor 3m, a feature angle
///        outside [0, 180], an error that is negative or not finite.
/// Time O(m log m), memory 200 bytes a face. The same bits for any number of threads.
Decimation decimate(Points vertices, Triangles faces, const DecimateOptions& options);

/// The sides at which values of corners tear, as texture coordinates do where charts end: where two faces do not agree
/// on the values at both ends of their common side. For `DecimateOptions::seams`.
/// \param values  `components` numbers a corner, 3 corners a face.
/// \return a byte a corner, 1 where the side opposite to it is a seam; empty where there is none.
/// \throw std::invalid_argument: another number of values. Time O(m log m).
std::vector<std::uint8_t> corner_seams(Triangles faces, const std::vector<double>& values, std::size_t components);

}  // namespace gaussmap
