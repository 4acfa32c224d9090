// A triangle seen by many points near it.
#pragma once

#include <array>

#include "triangle_closest.h"
#include "vec.h"

namespace gaussmap {

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
        altitude_ = {nn / squared(c - b), nn / squared(a - c), nn / squared(b - a)};
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
    /// Is the foot further from every side than from p? Then it has no rival that does not fold back over the triangle.
    bool settled(const Foot& foot) const {
        const double h = foot.height * foot.height;
        const auto& w = foot.weights;
        return foot.inside && h < w[0] * w[0] * altitude_[0] && h < w[1] * w[1] * altitude_[1] &&
               h < w[2] * w[2] * altitude_[2];
    }

    std::array<Vec3, 3> corner{};
    Vec3 normal;  ///< of unit length, or 0

  private:
    Vec3 towards_b_, towards_c_;
    std::array<double, 3> altitude_{};  ///< squared
};

}  // namespace gaussmap
