#include "analytic.h"

#include <cmath>
#include <utility>

#include "arguments.h"
#include "gaussmap/distance.h"
#include "random.h"

namespace gaussmap {
namespace {

/// Mean length of the sides of the faces.
double mean_side(const Surface& surface) {
    double sum = 0;
    for (std::size_t f = 0; f < surface.faces.size(); f += 3) {
        const std::int32_t* abc = surface.faces.data() + f;
        for (int c = 0; c < 3; ++c) {
            const Vec3 from = load(surface.vertices.data() + 3 * static_cast<std::size_t>(abc[c]));
            const Vec3 to = load(surface.vertices.data() + 3 * static_cast<std::size_t>(abc[(c + 1) % 3]));
            sum += length(to - from);
        }
    }
    return sum / static_cast<double>(surface.faces.size());
}

}  // namespace

Vec3 perpendicular(Vec3 n) {
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const Vec3 axis = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    return normalized(cross(n, axis));
}

SurfacePoint on_level_set(Vec3 position, Vec3 gradient, const Symmetric3& hessian) {
    // dN on the tangent plane is the Hessian restricted to it, over |gradient|; its eigenvalues are k1 and k2.
    const double steepness = length(gradient);
    const Vec3 normal = (1 / steepness) * gradient;
    const Vec3 u = perpendicular(normal), v = cross(normal, u);
    const Vec3 hu = hessian * u, hv = hessian * v;
    const double uu = dot(u, hu), uv = dot(u, hv), vv = dot(v, hv);
    const double middle = (uu + vv) / 2, apart = std::hypot((uu - vv) / 2, uv);
    return {position, normal, (middle + apart) / steepness, (middle - apart) / steepness};
}

void check_options(const char* function, const SurfaceOptions& options) {
    const auto fraction = [&](const char* parameter, double value) {
        require(std::isfinite(value) && value >= 0, function, parameter, value, "be finite and at least 0");
    };
    fraction("jitter", options.jitter);
    fraction("noise", options.noise);
}

Surface blank_surface(std::size_t count, std::vector<std::int32_t> faces) {
    Surface surface;
    surface.vertices.resize(3 * count);
    surface.faces = std::move(faces);
    surface.normals.resize(3 * count);
    surface.k1.resize(count);
    surface.k2.resize(count);
    surface.density.resize(count);
    return surface;
}

void store_point(Surface& surface, std::size_t vertex, const SurfacePoint& point) {
    store(surface.vertices.data() + 3 * vertex, point.position);
    store(surface.normals.data() + 3 * vertex, point.normal);
    surface.k1[vertex] = point.k1;
    surface.k2[vertex] = point.k2;
    surface.density[vertex] = point.k1 * point.k1 + point.k2 * point.k2;
}

void add_noise(Surface& surface, const SurfaceOptions& options) {
    if (options.noise == 0) return;
    const double unit =
        options.noise_unit == NoiseUnit::edge ? mean_side(surface) : box_diagonal(surface.vertices, surface.faces);
    const double deviation = options.noise * unit;
    Random random(options.seed, 1);  // stream 0 is the jitter's
    for (double& coordinate : surface.vertices) coordinate += deviation * random.normal();
}

}  // namespace gaussmap
