// What the analytic surfaces share: a point with its exact normal and principal curvatures, and how it is stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/surfaces.h"
#include "vec.h"

namespace gaussmap {

struct SurfacePoint {
    Vec3 position, normal;
    double k1 = 0, k2 = 0;
};

/// Row-major, symmetric.
struct Symmetric3 {
    double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
};

inline Vec3 operator*(const Symmetric3& m, Vec3 v) {
    return {m.xx * v.x + m.xy * v.y + m.zx * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
            m.zx * v.x + m.yz * v.y + m.zz * v.z};
}

inline Vec3 normalized(Vec3 a) {
    return (1 / length(a)) * a;
}

/// A unit vector perpendicular to the unit vector n.
Vec3 perpendicular(Vec3 n);

/// The point of a level set at which the defining function has this gradient (towards the outside) and Hessian.
SurfacePoint on_level_set(Vec3 position, Vec3 gradient, const Symmetric3& hessian);

/// \throw std::invalid_argument naming `function` on a jitter or a noise that is negative or not finite.
void check_options(const char* function, const SurfaceOptions& options);

/// A surface of `count` vertices, all still to be stored.
Surface blank_surface(std::size_t count, std::vector<std::int32_t> faces);

void store_point(Surface& surface, std::size_t vertex, const SurfacePoint& point);

/// Add the noise of the options to the vertices.
void add_noise(Surface& surface, const SurfaceOptions& options);

}  // namespace gaussmap
