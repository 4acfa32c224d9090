// Surfaces over a grid of parameters: torus, catenoid, cylinder, plane, waves. Tubes are in tubes.cpp, round ones in
// spheres.cpp.

#include "gaussmap/surfaces.h"

#include <cmath>
#include <numbers>

#include "analytic.h"
#include "arguments.h"
#include "grid.h"

namespace gaussmap {
namespace {

constexpr double turn = 2 * std::numbers::pi;

void check(const char* function, const Grid& grid, const SurfaceOptions& options) {
    check_grid(function, grid);
    check_options(function, options);
}

}  // namespace

Surface torus(double major, double minor, int around, int across, const SurfaceOptions& options) {
    require_positive("torus", "major", major);
    require_positive("torus", "minor", minor);
    require(minor < major, "torus", "minor", minor, "be less than major = " + shown(major));
    const Grid grid{around, across};
    check("torus", grid, options);
    return grid_surface(grid, options, [&](const GridPoint& at) {
        const double cos_u = std::cos(turn * at.u), sin_u = std::sin(turn * at.u);
        const double cos_v = std::cos(turn * at.v), sin_v = std::sin(turn * at.v);
        const double from_axis = major + minor * cos_v;
        return SurfacePoint{{from_axis * cos_u, from_axis * sin_u, minor * sin_v},
                            {cos_v * cos_u, cos_v * sin_u, sin_v},
                            1 / minor,
                            cos_v / from_axis};
    });
}

Surface catenoid(double neck, double height, int around, int across, const SurfaceOptions& options) {
    require_positive("catenoid", "neck", neck);
    require_positive("catenoid", "height", height);
    const double rim = std::cosh(height / (2 * neck));
    require(std::isfinite(neck * rim * rim), "catenoid", "height", height,
            "be less for a rim that is a number, neck being " + shown(neck));
    const Grid grid{around, across, true, false};
    check("catenoid", grid, options);
    return grid_surface(grid, options, [&](const GridPoint& at) {
        const double cos_u = std::cos(turn * at.u), sin_u = std::sin(turn * at.u);
        const double z = height * (at.v - 0.5);
        const double wide = std::cosh(z / neck), steep = std::sinh(z / neck);
        const double k = 1 / (neck * wide * wide);
        return SurfacePoint{
            {neck * wide * cos_u, neck * wide * sin_u, z}, {cos_u / wide, sin_u / wide, -steep / wide}, k, -k};
    });
}

Surface cylinder(double radius, double height, int around, int across, const SurfaceOptions& options) {
    require_positive("cylinder", "radius", radius);
    require_positive("cylinder", "height", height);
    const Grid grid{around, across, true, false};
    check("cylinder", grid, options);
    return grid_surface(grid, options, [&](const GridPoint& at) {
        const double cos_u = std::cos(turn * at.u), sin_u = std::sin(turn * at.u);
        return SurfacePoint{{radius * cos_u, radius * sin_u, height * (at.v - 0.5)}, {cos_u, sin_u, 0}, 1 / radius, 0};
    });
}

Surface plane(double width, double depth, int around, int across, const SurfaceOptions& options) {
    require_positive("plane", "width", width);
    require_positive("plane", "depth", depth);
    const Grid grid{around, across, false, false};
    check("plane", grid, options);
    return grid_surface(grid, options, [&](const GridPoint& at) {
        return SurfacePoint{{width * (at.u - 0.5), depth * (at.v - 0.5), 0}, {0, 0, 1}, 0, 0};
    });
}

Surface waves(double width, double depth, double amplitude, double wavelength, int around, int across,
              const SurfaceOptions& options) {
    require_positive("waves", "width", width);
    require_positive("waves", "depth", depth);
    require(std::isfinite(amplitude), "waves", "amplitude", amplitude, "be finite");
    require_positive("waves", "wavelength", wavelength);
    const Grid grid{around, across, false, false};
    check("waves", grid, options);
    const double f = turn / wavelength;
    // Level set of z − h(x, y).
    return grid_surface(grid, options, [&](const GridPoint& at) {
        const double x = width * (at.u - 0.5), y = depth * (at.v - 0.5);
        const double cos_x = std::cos(f * x), sin_x = std::sin(f * x), cos_y = std::cos(f * y), sin_y = std::sin(f * y);
        const double h = amplitude * cos_x * cos_y, bend = f * f * h, twist = f * f * amplitude * sin_x * sin_y;
        return on_level_set({x, y, h}, {f * amplitude * sin_x * cos_y, f * amplitude * cos_x * sin_y, 1},
                            {bend, bend, 0, -twist, 0, 0});
    });
}

}  // namespace gaussmap
