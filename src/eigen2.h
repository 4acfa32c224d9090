// Principal curvatures and directions: a symmetric 2×2 matrix in a tangent plane, diagonalised.
#pragma once

#include <cmath>
#include <limits>

#include "frame.h"
#include "vec.h"

namespace gaussmap {

/// The upper triangle, in the frame (u, v) of a tangent plane.
struct Symmetric2 {
    double uu = 0, uv = 0, vv = 0;
};

/// k1 ≥ k2 and the unit direction of k1, looking up.
struct Principal {
    double k1 = std::numeric_limits<double>::quiet_NaN(), k2 = k1;
    Vec3 direction = {k1, k1, k1};
};

/// In closed form: with the mean m and half the difference d of the diagonal, r = √(d² + uv²), the eigenvalues are
/// m ± r and the direction of the greater has twice the angle of (d, uv). −s gives −k2, −k1 and the other direction to
/// the last bit; where r = 0, which an umbilic need not reach in rounding, it is u.
inline Principal principal(Symmetric2 s, const Frame& frame) {
    const double m = 0.5 * (s.uu + s.vv), d = 0.5 * (s.uu - s.vv), r = std::sqrt(d * d + s.uv * s.uv);
    // Of the two forms of the half angle's tangent the one without cancellation.
    const Vec3 along = d >= 0 ? (d + r) * frame.u + s.uv * frame.v : s.uv * frame.u + (r - d) * frame.v;
    return {m + r, m - r, upward(r > 0 ? unit(along) : frame.u)};
}

}  // namespace gaussmap
