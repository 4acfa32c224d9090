// Lachaud, Romon, Thibert, Coeurjolly, "Interpolated corrected curvature measures for polygonal surfaces", Computer
// Graphics Forum 39(5), 2020; measures of a triangle with normals u interpolated linearly (docs/method.md, eq. (6)).
#include "corrected_curvature.h"

#include <cmath>
#include <limits>

#include "degenerate.h"
#include "scatter.h"
#include "vec.h"

namespace gaussmap {

std::vector<double> corrected_density(Points vertices, Triangles faces, Points unit_normals, const Execution& run) {
    const auto measures = [&](std::size_t f, double(&corners)[3][3]) {
        const std::int32_t *t = faces[f], i = t[0], j = t[1], k = t[2];
        const Vec3 ui = load(unit_normals[i]), uj = load(unit_normals[j]), uk = load(unit_normals[k]);
        // From corner i on: the measures depend on differences of positions alone, so a far origin costs nothing.
        const Vec3 ij = load(vertices[j]) - load(vertices[i]), ik = load(vertices[k]) - load(vertices[i]);
        const Vec3 jk = load(vertices[k]) - load(vertices[j]), normal = cross(ij, ik);
        const double half_squares = 0.5 * (squared(ij) + squared(ik) + squared(jk));
        if (no_area(squared(normal), half_squares)) return false;
        const Vec3 mean = (1.0 / 3) * (ui + uj + uk);
        double mu0 = 0.5 * dot(mean, normal);
        double mu1 = 0.5 * dot(mean, cross(ui - uk, ij) + cross(uj - ui, ik));
        // ui · (uj × uk) with differences, for accuracy where the three are close.
        double mu2 = 0.5 * dot(ui, cross(uj - ui, uk - ui));
        if (!std::isfinite(mu0) || !std::isfinite(mu1) || !std::isfinite(mu2)) return false;
        // A face wound against its normals counts as if it were turned over: the winding of faces is immaterial.
        if (mu0 < 0) mu0 = -mu0, mu1 = -mu1, mu2 = -mu2;
        for (auto& corner : corners) corner[0] = mu0, corner[1] = mu1, corner[2] = mu2;
        return true;
    };
    const std::vector<double> sums =
        scatter_faces<3>(faces, vertices.count, chunk_faces(faces, vertices.count, run), run, measures);
    std::vector<double> density(vertices.count);
    for (std::size_t v = 0; v < density.size(); ++v) {
        const double mu0 = sums[3 * v], twice_h = sums[3 * v + 1] / mu0, k = sums[3 * v + 2] / mu0;
        density[v] = mu0 > 0 ? std::max(0.0, twice_h * twice_h - 2 * k) : std::numeric_limits<double>::quiet_NaN();
    }
    return density;
}

}  // namespace gaussmap
