// What the estimators that fit something are all tried on, for meshes.
#pragma once

#include <limits>

#include "gaussmap/curvature.h"
#include "gaussmap/surfaces.h"
#include "support.h"

namespace support {

/// A unit sphere and, after its vertices: one that is isolated; one that is not a number, with a face; a duplicate of
/// the first. Then a face of a repeated corner, and a third face on an edge.
inline gaussmap::Surface odd_sphere() {
    gaussmap::Surface s = gaussmap::sphere(2);
    const std::vector<double> first(s.vertices.begin(), s.vertices.begin() + 3);
    const std::vector<std::int32_t> f(s.faces.begin(), s.faces.begin() + 5);
    const auto n = static_cast<std::int32_t>(s.density.size());
    for (const double x : {5.0, 5.0, 5.0, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}) s.vertices.push_back(x);
    s.vertices.insert(s.vertices.end(), first.begin(), first.end());
    s.faces.insert(s.faces.end(), {0, 1, n + 1, 2, 2, 3, f[0], f[1], 40, n + 2, f[3], f[4]});
    return s;
}

inline void expect_same_bits(const gaussmap::MeshCurvature& a, const gaussmap::MeshCurvature& b) {
    EXPECT_TRUE(same_bits(a.density, b.density));
    EXPECT_TRUE(same_bits(a.error, b.error));
    EXPECT_TRUE(same_bits(a.normals, b.normals));
}

}  // namespace support
