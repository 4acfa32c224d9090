// Surfaces that are stretched from the subdivided icosahedron: sphere, ellipsoid, bumpy sphere.

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "analytic.h"
#include "arguments.h"
#include "gaussmap/surfaces.h"
#include "icosphere.h"
#include "random.h"

namespace gaussmap {
namespace {

void check(const char* function, int subdivisions, const SurfaceOptions& options) {
    require(subdivisions >= 0 && subdivisions <= 12, function, "subdivisions", subdivisions, "be in [0, 12]");
    check_options(function, options);
}

/// Mean length of the sides of the faces at each vertex.
std::vector<double> mean_sides(const Icosphere& sphere) {
    const std::size_t n = sphere.directions.size() / 3;
    std::vector<double> sum(n);
    std::vector<std::uint8_t> sides(n);  // 5 or 6 faces, 2 sides each
    for (std::size_t f = 0; f < sphere.faces.size(); f += 3)
        for (int c = 0; c < 3; ++c) {
            const auto a = static_cast<std::size_t>(sphere.faces[f + c]);
            const auto b = static_cast<std::size_t>(sphere.faces[f + (c + 1) % 3]);
            const double side = length(load(&sphere.directions[3 * b]) - load(&sphere.directions[3 * a]));
            sum[a] += side, sum[b] += side;
            ++sides[a], ++sides[b];
        }
    for (std::size_t v = 0; v < n; ++v) sum[v] /= sides[v];
    return sum;
}

void jitter(Icosphere& sphere, const SurfaceOptions& options) {
    if (options.jitter == 0) return;
    const std::vector<double> edge = mean_sides(sphere);
    Random random(options.seed, 0);
    for (std::size_t v = 0; v < edge.size(); ++v) {
        const Vec3 d = load(&sphere.directions[3 * v]);
        const Vec3 right = perpendicular(d), up = cross(d, right);
        const double step_right = options.jitter * edge[v] * random.symmetric();
        const double step_up = options.jitter * edge[v] * random.symmetric();
        store(&sphere.directions[3 * v], normalized(d + step_right * right + step_up * up));
    }
}

/// The surface of SurfacePoint point_towards(Vec3 direction).
template <class PointTowards>
Surface stretched(int subdivisions, const SurfaceOptions& options, PointTowards&& point_towards) {
    Icosphere sphere = icosphere(subdivisions);
    jitter(sphere, options);
    const std::size_t n = sphere.directions.size() / 3;
    Surface surface = blank_surface(n, std::move(sphere.faces));
    for (std::size_t v = 0; v < n; ++v) store_point(surface, v, point_towards(load(&sphere.directions[3 * v])));
    add_noise(surface, options);
    return surface;
}

/// r (1 + amplitude · g(x/|x|)) with g(d) = sin(f dx) sin(f dy) sin(f dz), as the zero set of
/// F(x) = |x| − r − r·amplitude·g(x/|x|). With P = I − d dᵀ, ρ = |x| and t = P ∇g:
///   ∇(g(x/|x|)) = t / ρ,   ∇²(g(x/|x|)) = (P ∇²g P − (d·∇g) P − d tᵀ − t dᵀ) / ρ²,   ∇|x| = d,   ∇²|x| = P / ρ.
SurfacePoint bump(Vec3 d, double radius, double amplitude, double frequency) {
    const double f = frequency;
    const Vec3 s{std::sin(f * d.x), std::sin(f * d.y), std::sin(f * d.z)};
    const Vec3 c{std::cos(f * d.x), std::cos(f * d.y), std::cos(f * d.z)};
    const double g = s.x * s.y * s.z;
    const Vec3 slope{f * c.x * s.y * s.z, f * s.x * c.y * s.z, f * s.x * s.y * c.z};
    const double f2 = f * f;
    const Symmetric3 second{
        -f2 * g, -f2 * g, -f2 * g, f2 * c.x * c.y * s.z, f2 * s.x * c.y * c.z, f2 * c.x * s.y * c.z};

    const double rho = radius * (1 + amplitude * g), scale = radius * amplitude;
    const Vec3 t = slope - dot(d, slope) * d;
    // P M P = M − d (M d)ᵀ − (M d) dᵀ + (dᵀ M d) d dᵀ; the d tᵀ + t dᵀ joins its two middle terms.
    const Vec3 md = second * d, w = md + t;
    const double dmd = dot(d, md), down = dot(d, slope);
    const auto entry = [&](double m, double di, double dj, double wi, double wj, double identity) {
        const double projected = identity - di * dj;
        const double angular = m - di * wj - wi * dj + dmd * di * dj - down * projected;
        return projected / rho - scale * angular / (rho * rho);
    };
    const Symmetric3 hessian{entry(second.xx, d.x, d.x, w.x, w.x, 1), entry(second.yy, d.y, d.y, w.y, w.y, 1),
                             entry(second.zz, d.z, d.z, w.z, w.z, 1), entry(second.xy, d.x, d.y, w.x, w.y, 0),
                             entry(second.yz, d.y, d.z, w.y, w.z, 0), entry(second.zx, d.z, d.x, w.z, w.x, 0)};
    return on_level_set(rho * d, d - (scale / rho) * t, hessian);
}

}  // namespace

Surface sphere(int subdivisions, double radius, const SurfaceOptions& options) {
    require_positive("sphere", "radius", radius);
    check("sphere", subdivisions, options);
    return stretched(subdivisions, options, [&](Vec3 d) {
        return SurfacePoint{radius * d, d, 1 / radius, 1 / radius};
    });
}

Surface ellipsoid(double a, double b, double c, int subdivisions, const SurfaceOptions& options) {
    require_positive("ellipsoid", "a", a);
    require_positive("ellipsoid", "b", b);
    require_positive("ellipsoid", "c", c);
    check("ellipsoid", subdivisions, options);
    // Level set of (x²/a² + y²/b² + z²/c²) / 2.
    const Symmetric3 hessian{1 / (a * a), 1 / (b * b), 1 / (c * c), 0, 0, 0};
    return stretched(subdivisions, options, [&](Vec3 d) {
        return on_level_set({a * d.x, b * d.y, c * d.z}, {d.x / a, d.y / b, d.z / c}, hessian);
    });
}

Surface bumpy_sphere(double radius, double amplitude, double frequency, int subdivisions,
                     const SurfaceOptions& options) {
    require_positive("bumpy_sphere", "radius", radius);
    require(std::abs(amplitude) < 1, "bumpy_sphere", "amplitude", amplitude, "be in (-1, 1)");
    require(std::isfinite(frequency), "bumpy_sphere", "frequency", frequency, "be finite");
    check("bumpy_sphere", subdivisions, options);
    return stretched(subdivisions, options, [&](Vec3 d) { return bump(d, radius, amplitude, frequency); });
}

}  // namespace gaussmap
