// Exact k nearest neighbours in space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// For each of n points, up to k others, nearest first, equal distances by smaller index.
/// Row i of `index` (k entries) is filled with −1 where there are fewer than k others.
struct Neighbors {
    std::size_t k = 0;
    std::vector<std::int32_t> index;

    std::size_t count() const { return k == 0 ? 0 : index.size() / k; }
    const std::int32_t* operator[](std::size_t i) const { return index.data() + i * k; }
};

/// The k nearest others of every point (a point is not its own neighbour; copies of it are neighbours
/// at distance 0). Exact, and the same bits for any number of threads.
/// \param points  n finite points, at most 2³¹ − 1.
/// \throw std::invalid_argument on k < 1, a non-finite point (its index is named) or too many points.
/// Time O(n k log k) for points on surfaces; memory 4k + 36 bytes a point.
/// However many points are equal, it is never quadratic.
Neighbors nearest_neighbors(Points points, int k, const Execution& run = {});

/// For each of some queries, up to k points, nearest first, equal distances by smaller index.
/// Rows of k entries; where there are fewer than k points, `index` is filled with −1.
struct NearestPoints {
    std::size_t k = 0;
    std::vector<std::int32_t> index;
    std::vector<double> squared_distance;  ///< infinite where the index is −1; empty unless asked for
};

struct NeighborTree;

/// Points made ready for queries at any place. Copies the points (36 bytes each); copies of the index share them.
class NeighborIndex {
  public:
    /// \param points  n finite points, at most 2³¹ − 1. Time O(n) for points on surfaces.
    /// \throw std::invalid_argument on a non-finite point (its index is named) or too many points.
    explicit NeighborIndex(Points points, const Execution& run = {});

    std::size_t count() const;

    /// The k points nearest to each query. A query that is itself a point finds that point, or a copy of it.
    /// Exact, and the same bits for any number of threads; fastest for many queries in one call, in any order.
    /// \throw std::invalid_argument on k < 1, a non-finite query (its index is named) or more than 2³¹ − 1 queries.
    /// Time O(k log k) a query for points on surfaces.
    NearestPoints nearest(Points queries, int k, bool distances = false, const Execution& run = {}) const;

  private:
    std::shared_ptr<const NeighborTree> tree_;
};

/// An order of the points in which near points are near each other: order[j] is the index of the j-th point along a
/// space-filling curve. Work on clouds runs faster in this order. It depends on the set of positions alone; equal
/// positions follow each other by index.
/// \throw std::invalid_argument on a non-finite point (its index is named) or more than 2³¹ − 1 points.
/// Time O(n) for points on surfaces; memory 20 bytes a point.
std::vector<std::int32_t> spatial_order(Points points, const Execution& run = {});

/// The cloud without repetitions: finite points, each position once (its first holder), in input order.
struct DistinctPoints {
    std::vector<double> points;        ///< 3 values each
    std::vector<std::int32_t> source;  ///< distinct point → input index
    std::vector<std::int32_t> target;  ///< input index → distinct point, −1 if not finite
    std::size_t duplicates = 0;        ///< finite inputs at the position of an earlier one
    std::size_t non_finite = 0;        ///< inputs with a NaN or infinite coordinate
};

/// \throw std::invalid_argument on more than 2³¹ − 1 points. Time O(n) for points on surfaces; +0 and −0 are equal.
DistinctPoints distinct_points(Points points);

/// The Delaunay triangles incident on each point among its projected neighbours ("fan"), as closed or
/// open chains of neighbours in counterclockwise order about the normal.
/// Chain of point i: `index[begin[i]] … index[begin[i+1] − 1]`; a triangle (i, index[j], index[j+1]) for each
/// consecutive pair, and (i, last, first) too where `closed[i]`.
struct Fans {
    std::vector<std::uint64_t> begin;  ///< n + 1 offsets
    std::vector<std::int32_t> index;   ///< neighbour indices
    std::vector<std::uint8_t> closed;  ///< 0: a boundary point
};

/// The fan of every point, by inversion and one hull (docs/method.md, eq. (7)).
/// \param points     n finite points.
/// \param normals    n normals of any positive length; a NaN or zero normal gives an empty fan.
/// \param neighbors  of these points.
/// Neighbours cocircular with the point all stay in its fan, so that the fan does not depend on how points are
/// numbered; of neighbours in one direction the nearest stays, of equal ones the first. \throw std::invalid_argument on
/// arrays of different lengths, or a neighbour that is no point (its row is named). Time O(n k log k).
Fans fans(Points points, Points normals, const Neighbors& neighbors, const Execution& run = {});

}  // namespace gaussmap
