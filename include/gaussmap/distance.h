// Distances between surfaces and clouds, by exact closest points: sampled both ways, or bounded with certainty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// For each of n queries, the closest point of a surface or a cloud.
struct ClosestPoints {
    std::vector<double> distance;  ///< n, length
    std::vector<double> points;    ///< 3n: the closest points
    std::vector<std::int32_t>
        element;  ///< n: the faces (of a cloud, the points) that they lie on, of several the first
};

struct ClosestTree;
struct HausdorffInterval;
struct HausdorffOptions;

/// A surface, or a cloud, made ready for closest points from any place. Exact: what is found is the minimum over all
/// triangles (points), each distance with a rounding error of a few units in the last place of the lengths involved,
/// however thin the triangle. Copies of the index share its data; queries may run side by side.
class ClosestIndex {
  public:
    /// \param vertices  finite where a face uses them; of a cloud, everywhere.
    /// \param faces     none make a cloud of the vertices. Degenerate ones are the segments and points that they are.
    /// \throw std::invalid_argument on an index outside [0, vertices.count), a vertex that is not finite (which is
    /// named), no vertices at all, or more than 2³¹ − 1 faces or points.
    /// Time O(n log n); memory 160 bytes a face and 32 more while it is made, 60 a point.
    explicit ClosestIndex(Points vertices, Triangles faces = {}, const Execution& run = {});

    /// Distance of each query, and no more. \throw std::invalid_argument on a query that is not finite (which is named)
    /// or more than 2³¹ − 1 queries. Fastest for many queries in one call, in any order: O(log n) each, near surfaces.
    std::vector<double> distances(Points queries, const Execution& run = {}) const;

    /// The same with the closest points and what they lie on.
    ClosestPoints closest(Points queries, const Execution& run = {}) const;

  private:
    friend HausdorffInterval hausdorff_bound(Points, Triangles, const ClosestIndex&, const HausdorffOptions&);
    std::shared_ptr<const ClosestTree> tree_;
};

/// Statistics of the distances from one surface or cloud to another; lengths.
struct Deviation {
    double max = 0;   ///< over all samples: a lower bound of the one-sided Hausdorff distance
    double rms = 0;   ///< over the surface: the samples on faces, spread evenly by area (all points of a cloud)
    double mean = 0;  ///< as rms
};

struct SampleCounts {
    std::size_t vertices = 0;  ///< those of faces, each once; all points of a cloud
    std::size_t edges = 0;
    std::size_t faces = 0;
};

struct DistanceOptions {
    /// Points spread over the faces of each surface, and a quarter as many over its edges; besides, all vertices.
    std::size_t samples = 500000;
    /// Same seed, same samples, on every machine and for any number of threads.
    std::uint64_t seed = 0;
    Execution run;
};

struct SurfaceDistance {
    Deviation forward;    ///< from a to b
    Deviation backward;   ///< from b to a
    Deviation symmetric;  ///< the larger of both ways, each
    SampleCounts forward_samples, backward_samples;
    double diagonal = 0;  ///< of the box of a: what MeshLab divides by
};

/// The distances between two surfaces (or clouds, where there are no faces), both ways, from samples on vertices, edges
/// and faces (Cignoni, Rocchini, Scopigno 1998, "Metro: measuring error on simplified surfaces").
/// \throw std::invalid_argument as ClosestIndex does, its message beginning with "a: " or "b: ".
/// Time: under a microsecond a sample on one thread.
SurfaceDistance surface_distance(Points a, Triangles faces_a, Points b, Triangles faces_b,
                                 const DistanceOptions& options = {});

/// Diagonal of the box of the vertices that faces use; of all vertices where there are no faces.
double box_diagonal(Points vertices, Triangles faces = {});

struct HausdorffOptions {
    /// Stop when upper − lower is at most this; a length. 0 takes 1e-4 of the diagonal of the box of a.
    double tolerance = 0;
    /// Stop as soon as the interval lies on one side of this length: lower > limit, or upper ≤ limit.
    double limit = -1;
    /// Give up after so many closest points, leaving the interval wider than asked for.
    std::size_t most_queries = std::size_t{1} << 25;
    Execution run;
};

/// lower ≤ max over the points p of a, of the distance from p to b ≤ upper, rounding included.
struct HausdorffInterval {
    double lower = 0, upper = 0;
    double at[3] = {0, 0, 0};      ///< a point of a that is `lower` away from b
    std::size_t queries = 0;       ///< closest points that it took
    bool within_tolerance = true;  ///< or decided by the limit; false after most_queries
};

/// The one-sided Hausdorff distance from a to b, bounded with certainty: triangles of a are halved until the distance
/// on each is known well enough. From above, distances to one fixed triangle of b are convex, so that their maximum
/// over a triangle of a is at a corner; from below, corners are points of a. The vertices of a cloud need no halving.
/// \throw std::invalid_argument on an a that ClosestIndex would not take, or a tolerance that is negative or not
/// finite.
HausdorffInterval hausdorff_bound(Points a, Triangles faces_a, const ClosestIndex& b,
                                  const HausdorffOptions& options = {});

}  // namespace gaussmap
