// The normal of one point of a cloud, fitted to its neighbours.
#pragma once

#include <tuple>
#include <vector>

#include "frame.h"
#include "gaussmap/normals.h"
#include "lane_fits.h"
#include "lane_neighborhoods.h"
#include "least_squares.h"

namespace gaussmap {

/// The normal at the point of h(u, v) = Σ c_ij uⁱ vʲ, 1 ≤ i + j ≤ Degree, fitted to the neighbours over a frame
/// (docs/method.md, eq. (8)). There is no constant term: the height field passes through the point.
template <int Degree>
class Jet {
  public:
    static constexpr int unknowns = Degree * (Degree + 3) / 2;

    explicit Jet(std::size_t k) : columns_((unknowns + 1) * padded(k)) {}

    /// False where the neighbours do not determine the fit.
    bool fit(const Neighborhood& neighborhood, const Frame& frame, Vec3& normal);

  private:
    void fill(const Neighborhood& neighborhood, const Frame& frame);
    bool solve_normal_equations(std::size_t slots, double& cu, double& cv) const;
    bool solve_by_reflections(std::size_t count, double& cu, double& cv);

    std::vector<double> columns_;  ///< the monomials u v u² uv v² u³ …, then the height; an entry a neighbour
    std::size_t stride_ = 0;
    LeastSquares<unknowns> problem_;
};

/// Normals by any method, and the room they are fitted in; reused from point to point.
class NormalFit {
  public:
    NormalFit(CloudNormals method, int degree, std::size_t k)
        : method_(method), degree_(degree), jets_(Jet<1>(k), Jet<2>(k), Jet<3>(k), Jet<4>(k)) {}

    struct Result {
        Vec3 normal;           ///< unit, looking up; NaN where undefined
        bool lowered = false;  ///< the jet took a lower degree than asked for
    };
    /// Of up to `fit_lanes` points, which takes as long as of one; the same bits for one as for more.
    void operator()(LaneNeighborhoods& around, Result (&results)[fit_lanes]);

  private:
    struct Group {
        Frame frame[fit_lanes];
        bool wanted[fit_lanes];
    };
    void find_principal(LaneNeighborhoods& around, Result (&results)[fit_lanes]) const;
    void fit_in_lanes(int degree, LaneNeighborhoods& around, const Group& group);
    bool fit_alone(int degree, const Neighborhood& neighborhood, const Frame& frame, Vec3& normal);

    CloudNormals method_;
    int degree_;
    std::tuple<Jet<1>, Jet<2>, Jet<3>, Jet<4>> jets_;
    LaneSums sums_;
    LaneFields fields_ = {};
};

}  // namespace gaussmap
