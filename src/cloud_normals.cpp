// Normals of cloud points: the smallest principal direction of the neighbours (Hoppe et al. 1992), and above it the
// normal of a polynomial height field fitted to them (Cazals and Pouget 2005).
#include <array>
#include <limits>
#include <stdexcept>
#include <string>

#include "check_cloud.h"
#include "eigen3.h"
#include "frame.h"
#include "gaussmap/normals.h"
#include "least_squares.h"
#include "neighborhood.h"
#include "parallel.h"

namespace gaussmap {
namespace {

/// Neighbours closer to a line than the root of this, relative to their spread, span no plane.
constexpr double line_tolerance = 1e-13;
/// A monomial that the others match this closely on the neighbours is not determined by them.
constexpr double rank_tolerance = 1e-4;

const Vec3 undefined = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::quiet_NaN()};

/// Of the point and its neighbours, about their mean.
Vec3 principal_normal(const Neighborhood& neighborhood) {
    Vec3 mean;
    for (std::size_t j = 0; j < neighborhood.count; ++j) mean = mean + neighborhood.offset[j];
    mean = 1.0 / static_cast<double>(neighborhood.count + 1) * mean;
    Symmetric3 m = {mean.x * mean.x, mean.x * mean.y, mean.x * mean.z,
                    mean.y * mean.y, mean.y * mean.z, mean.z * mean.z};
    for (std::size_t j = 0; j < neighborhood.count; ++j) {
        const Vec3 d = neighborhood.offset[j] - mean;
        m.xx += d.x * d.x, m.xy += d.x * d.y, m.xz += d.x * d.z;
        m.yy += d.y * d.y, m.yz += d.y * d.z, m.zz += d.z * d.z;
    }
    const Eigen3 principal = eigen(m);
    if (!(principal.values[1] > line_tolerance * principal.values[2])) return undefined;
    return upward(principal.vectors[0]);
}

/// The normal at the point of h(u, v) = Σ c_ij uⁱ vʲ, 1 ≤ i + j ≤ Degree, fitted to the neighbours over the given
/// frame. There is no constant term: the height field passes through the point.
template <int Degree>
class Jet {
  public:
    static constexpr int unknowns = Degree * (Degree + 3) / 2;

    /// False where the neighbours do not determine the fit.
    bool fit(const Neighborhood& neighborhood, const Frame& frame, Vec3& normal) {
        problem_.clear();
        for (std::size_t j = 0; j < neighborhood.count; ++j) {
            const Vec3 d = neighborhood.offset[j];
            const double u = dot(d, frame.u), v = dot(d, frame.v);
            auto& row = problem_.add();
            row[0] = u, row[1] = v;
            for (int degree = 2, at = 2; degree <= Degree; ++degree) {
                for (int i = 0; i < degree; ++i, ++at) row[at] = u * row[at - degree];
                row[at] = v * row[at - degree - 1];
                ++at;
            }
            row[unknowns] = dot(d, frame.n);
        }
        std::array<double, unknowns> c;
        if (!problem_.solve(c, rank_tolerance)) return false;
        normal = unit(frame.n - c[0] * frame.u - c[1] * frame.v);
        return finite(normal);
    }

  private:
    LeastSquares<unknowns> problem_;
};

/// Jets of all degrees, and the room they work in.
struct Jets {
    Jet<1> first;
    Jet<2> second;
    Jet<3> third;
    Jet<4> fourth;

    /// The highest degree up to `degree` that the neighbours determine; 0 where none.
    int fit(int degree, const Neighborhood& neighborhood, const Frame& frame, Vec3& normal) {
        if (degree >= 4 && fourth.fit(neighborhood, frame, normal)) return 4;
        if (degree >= 3 && third.fit(neighborhood, frame, normal)) return 3;
        if (degree >= 2 && second.fit(neighborhood, frame, normal)) return 2;
        return first.fit(neighborhood, frame, normal) ? 1 : 0;
    }
};

}  // namespace

CloudNormalsResult cloud_normals(Points points, const Neighbors& neighbors, const CloudNormalsOptions& options) {
    check_degree(options.degree);
    check_neighbors(neighbors.index, neighbors.k, points.count);
    constexpr std::size_t grain = 1024;
    CloudNormalsResult result;
    result.normals.resize(3 * points.count);
    std::vector<std::size_t> undefined_in(block_count(points.count, grain)), lowered_in(undefined_in.size());
    for_blocks(points.count, grain, options.run, [&](std::size_t block, std::size_t i, std::size_t last) {
        Neighborhood neighborhood(neighbors.k);
        Jets jets;
        for (; i < last; ++i) {
            neighborhood.gather(points, i, neighbors[i]);
            Vec3 normal = principal_normal(neighborhood);
            if (!finite(normal)) {
                ++undefined_in[block];
            } else if (options.method == CloudNormals::jet) {
                const Frame frame = frame_about(normal);
                if (jets.fit(options.degree, neighborhood, frame, normal) < options.degree) ++lowered_in[block];
                normal = upward(normal);
            }
            store(result.normals.data() + 3 * i, normal);
        }
    });
    for (const std::size_t count : undefined_in) result.undefined += count;
    for (const std::size_t count : lowered_in) result.lowered += count;
    return result;
}

}  // namespace gaussmap
