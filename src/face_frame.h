// A triangle seen by many points near it.
#pragma once

#include <array>

#include "triangle_closest.h"
#include "vec.h"

namespace gaussmap {

/// Is a point's closest one on a triangle, of these weights, further from every side than from the point? Then it has
/// no rival that does not fold back over the triangle. \param sides  squared, of the sides opposite to the corners;
/// \param squared_area of the parallelogram; both over any common factor.
inline bool has_no_rival(double squared_distance, const std::array<double, 3>& weights,
                         const std::array<double, 3>& sides, double squared_area = 1) {
    bool none = true;
    for (std::size_t k = 0; k < 3; ++k)
        none = none && weights[k] > 0 && squared_distance * sides[k] < weights[k] * weights[k] * squared_area;
    return none;
}

/// Points straight above a triangle, by far the most, are told by three products with what is made once. A triangle
/// without area has none.
class FaceFrame {
  public:
    FaceFrame() = default;
    FaceFrame(Vec3 a, Vec3 b, Vec3 c) : corner{a, b, c} {
        const Vec3 n = cross(b - a, c - a);
        const double nn = squared(n);
        if (!(nn > 0)) return;
        normal = 1 / std::sqrt(nn) * n;
        towards_b_ = 1 / nn * cross(c - a, n);
        towards_c_ = 1 / nn * cross(n, b - a);
        sides_ = {squared(c - b) / nn, squared(a - c) / nn, squared(b - a) / nn};
    }

    /// Above the triangle or below it: its height, and the weights of the corners at its foot.
    struct Foot {
        bool inside;  ///< else nothing else holds
        double height;
        std::array<double, 3> weights;
    };
    Foot foot(Vec3 p) const {
        const Vec3 r = p - corner[0];
        const double v = dot(towards_b_, r), w = dot(towards_c_, r), u = 1 - v - w;
        return {u > 0 && v > 0 && w > 0, dot(normal, r), {u, v, w}};
    }
    bool settled(const Foot& foot) const {
        return foot.inside && has_no_rival(foot.height * foot.height, foot.weights, sides_);
    }

    std::array<Vec3, 3> corner{};
    Vec3 normal;  ///< of unit length, or 0

  private:
    Vec3 towards_b_, towards_c_;
    std::array<double, 3> sides_{};  ///< squared, over the squared area of the parallelogram
};

}  // namespace gaussmap
