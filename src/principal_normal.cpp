#include "principal_normal.h"

#include <algorithm>
#include <limits>

#include "eigen3.h"
#include "frame.h"

namespace gaussmap {
namespace {

constexpr Two one = {1, 1};

/// The weights of the neighbours; the point itself weighs 1.
struct Even {
    GAUSSMAP_LANES Four operator()(Four /*squared*/) const { return {one, one}; }
};
struct Smooth {
    double over_h_squared;
    GAUSSMAP_LANES Four operator()(Four squared) const {
        const Four rest = Four{one, one} - squared * over_h_squared;
        return rest * rest;
    }
};

/// Second moments of the point and its neighbours about their mean.
template <class Weight>
Symmetric3 moments(const Neighborhood& neighborhood, const Weight& weight) {
    Four w, x, y, z, xx, xy, xz, yy, yz, zz;
    for (std::size_t j = 0; j < neighborhood.count; j += lanes) {
        const Four dx = load_four(&neighborhood.x[j]), dy = load_four(&neighborhood.y[j]);
        const Four dz = load_four(&neighborhood.z[j]), s = weight(dx * dx + dy * dy + dz * dz);
        const Four wx = s * dx, wy = s * dy, wz = s * dz;
        w += s, x += wx, y += wy, z += wz;
        xx += wx * dx, xy += wx * dy, xz += wx * dz;
        yy += wy * dy, yz += wy * dz, zz += wz * dz;
    }
    // What fills the arrays up weighs 1 at the centre, and so does the centre.
    const double filled = static_cast<double>(padded(neighborhood.count) - neighborhood.count);
    const double all = total(w) - filled + 1;
    const Vec3 sum = {total(x), total(y), total(z)}, mean = (1 / all) * sum;
    return {total(xx) - sum.x * mean.x, total(xy) - sum.x * mean.y, total(xz) - sum.x * mean.z,
            total(yy) - sum.y * mean.y, total(yz) - sum.y * mean.z, total(zz) - sum.z * mean.z};
}

Symmetric3 moments(std::span<const Vec3> neighbors) {
    Symmetric3 m;
    Vec3 sum;
    for (const Vec3 d : neighbors) {
        sum = sum + d;
        m.xx += d.x * d.x, m.xy += d.x * d.y, m.xz += d.x * d.z;
        m.yy += d.y * d.y, m.yz += d.y * d.z, m.zz += d.z * d.z;
    }
    const Vec3 mean = 1 / (static_cast<double>(neighbors.size()) + 1) * sum;
    return {m.xx - sum.x * mean.x, m.xy - sum.x * mean.y, m.xz - sum.x * mean.z,
            m.yy - sum.y * mean.y, m.yz - sum.y * mean.z, m.zz - sum.z * mean.z};
}

/// The same from differences to the mean, which cancel nothing, one after the other.
/// \param offset  offset(j) is the difference of neighbour j from the point, weight_of(d) what it weighs.
template <class Offset, class WeightOf>
Symmetric3 careful_moments(std::size_t count, const Offset& offset, const WeightOf& weight_of) {
    Vec3 mean;
    double all = 1;
    for (std::size_t j = 0; j < count; ++j) {
        const Vec3 d = offset(j);
        all += weight_of(d);
        mean = mean + weight_of(d) * d;
    }
    mean = 1 / all * mean;
    Symmetric3 m = {mean.x * mean.x, mean.x * mean.y, mean.x * mean.z,
                    mean.y * mean.y, mean.y * mean.z, mean.z * mean.z};
    for (std::size_t j = 0; j < count; ++j) {
        const double w = weight_of(offset(j));
        const Vec3 d = offset(j) - mean, wd = w * d;
        m.xx += wd.x * d.x, m.xy += wd.x * d.y, m.xz += wd.x * d.z;
        m.yy += wd.y * d.y, m.yz += wd.y * d.z, m.zz += wd.z * d.z;
    }
    return m;
}

/// \param careful  makes the moments once more where the quick ones do not tell enough.
template <class Careful>
Vec3 smallest_direction(const Symmetric3& quick, const Careful& careful) {
    /// Neighbours closer to a line than the root of this, relative to their spread, span no plane.
    constexpr double line_tolerance = 1e-13, nan = std::numeric_limits<double>::quiet_NaN();
    Vec3 normal;
    if (smallest_eigenvector(quick, normal)) return upward(normal);
    const Eigen3 principal = eigen(careful());
    if (!(principal.values[1] > line_tolerance * principal.values[2])) return {nan, nan, nan};
    return upward(principal.vectors[0]);
}

template <class Weight>
Vec3 principal_normal_by(const Neighborhood& neighborhood, const Weight& weight) {
    return smallest_direction(moments(neighborhood, weight), [&] {
        return careful_moments(
            neighborhood.count, [&](std::size_t j) { return neighborhood.offset(j); },
            [&](Vec3 d) {
                return weight(Four{squared(d) * one, one}).low[0];
            });
    });
}

}  // namespace

Vec3 principal_normal(const Neighborhood& neighborhood, bool weighted) {
    if (!weighted) return principal_normal_by(neighborhood, Even());
    double farthest = 0;
    for (std::size_t j = 0; j < neighborhood.count; ++j) farthest = std::max(farthest, squared(neighborhood.offset(j)));
    const auto k = static_cast<double>(neighborhood.count);
    return principal_normal_by(neighborhood, Smooth{farthest > 0 ? k / (farthest * (k + 1)) : 0});
}

Vec3 principal_normal(std::span<const Vec3> neighbors, int count) {
    const std::span<const Vec3> taken = neighbors.first(static_cast<std::size_t>(count));
    return smallest_direction(moments(taken), [&] {
        return careful_moments(
            taken.size(), [&](std::size_t j) { return taken[j]; }, [](Vec3) { return 1.0; });
    });
}

}  // namespace gaussmap
