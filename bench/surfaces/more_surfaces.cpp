#include "more_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace {

using gaussmap::Surface;
using gaussmap::SurfaceOptions;
using Vector = std::array<double, 3>;

/// Stores the exact normal and curvature at vertex i of a level set, from the gradient g and the Hessian h (xx, yy,
/// zz, xy) there, the other entries being 0 (Goldman 2005, "Curvature formulas for implicit curves and surfaces").
void store_curvature(Surface& surface, std::size_t i, const Vector& g, const std::array<double, 4>& h) {
    const double g2 = g[0] * g[0] + g[1] * g[1] + g[2] * g[2], steepness = std::sqrt(g2);
    const double ghg = h[0] * g[0] * g[0] + h[1] * g[1] * g[1] + h[2] * g[2] * g[2] + 2 * h[3] * g[0] * g[1];
    const double mean = (g2 * (h[0] + h[1] + h[2]) - ghg) / (2 * g2 * steepness);
    // gᵀ adj(H) g / |g|⁴
    const double adjugate = h[1] * h[2] * g[0] * g[0] + h[0] * h[2] * g[1] * g[1] +
                            (h[0] * h[1] - h[3] * h[3]) * g[2] * g[2] - 2 * h[3] * h[2] * g[0] * g[1];
    const double gauss = adjugate / (g2 * g2), apart = std::sqrt(std::max(0.0, mean * mean - gauss));
    for (int c = 0; c < 3; ++c) surface.normals[3 * i + c] = g[c] / steepness;
    surface.k1[i] = mean + apart;
    surface.k2[i] = mean - apart;
    surface.density[i] = 4 * mean * mean - 2 * gauss;
}

/// Displacement of each coordinate by noise is drawn by the library: the difference of a surface it made with noise
/// and one without, scaled from the side of its faces to the side of ours.
double mean_side(const Surface& surface) {
    double sum = 0;
    for (std::size_t f = 0; f < surface.faces.size(); f += 3)
        for (int c = 0; c < 3; ++c) {
            const double* a = &surface.vertices[3 * static_cast<std::size_t>(surface.faces[f + c])];
            const double* b = &surface.vertices[3 * static_cast<std::size_t>(surface.faces[f + (c + 1) % 3])];
            sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        }
    return sum / static_cast<double>(surface.faces.size());
}

void add_noise(Surface& surface, const Surface& clean_base, const Surface& noisy_base) {
    const double scale = mean_side(surface) / mean_side(clean_base);
    for (std::size_t j = 0; j < surface.vertices.size(); ++j)
        surface.vertices[j] += scale * (noisy_base.vertices[j] - clean_base.vertices[j]);
}

/// The surface that point(vertex index) makes of the library's `base(options)`, jitter and noise included.
template <class Base, class Point>
Surface made_of(const Base& base, const SurfaceOptions& options, const Point& point) {
    SurfaceOptions clean = options;
    clean.noise = 0;
    const Surface clean_base = base(clean);
    Surface surface = clean_base;
    for (std::size_t i = 0; i < surface.density.size(); ++i) point(surface, i);
    if (options.noise > 0) add_noise(surface, clean_base, base(options));
    return surface;
}

}  // namespace

Surface monkey_saddle(double amplitude, int around, int across, const SurfaceOptions& options) {
    const auto base = [&](const SurfaceOptions& o) { return gaussmap::plane(2, 2, around, across, o); };
    return made_of(base, options, [&](Surface& surface, std::size_t i) {
        const double x = surface.vertices[3 * i], y = surface.vertices[3 * i + 1], a = amplitude;
        surface.vertices[3 * i + 2] = a * (x * x * x - 3 * x * y * y);
        store_curvature(surface, i, {-3 * a * (x * x - y * y), 6 * a * x * y, 1},
                        {-6 * a * x, 6 * a * x, 0, 6 * a * y});
    });
}

Surface rounded_cube(double roundness, int subdivisions, const SurfaceOptions& options) {
    const auto base = [&](const SurfaceOptions& o) { return gaussmap::sphere(subdivisions, 1, o); };
    return made_of(base, options, [&](Surface& surface, std::size_t i) {
        double* p = &surface.vertices[3 * i];
        const double quartic = p[0] * p[0] * p[0] * p[0] + p[1] * p[1] * p[1] * p[1] + p[2] * p[2] * p[2] * p[2];
        // r² of quartic r⁴ + roundness r² = 1
        const double c = roundness, r = std::sqrt(2 / (c + std::sqrt(c * c + 4 * quartic)));
        Vector g;
        std::array<double, 4> h{};
        for (int d = 0; d < 3; ++d) {
            p[d] *= r;
            g[d] = 4 * p[d] * p[d] * p[d] + 2 * c * p[d];
            h[d] = 12 * p[d] * p[d] + 2 * c;
        }
        store_curvature(surface, i, g, h);
    });
}
