// Clouds on analytic surfaces with exact normals and total curvature, for the tests.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support.h"

namespace support {

struct Cloud {
    std::vector<double> points, normals, density;

    std::size_t count() const { return density.size(); }
    void add(std::array<double, 3> p, std::array<double, 3> n, double total) {
        points.insert(points.end(), p.begin(), p.end());
        normals.insert(normals.end(), n.begin(), n.end());
        density.push_back(total);
    }
};

/// Rows of nearly square cells of edge `step`, one point anywhere in the middle half of each cell.
inline Cloud torus_cloud(double major, double minor, double step, std::uint64_t seed) {
    Random random(seed);
    Cloud cloud;
    const double turn = 2 * std::numbers::pi;
    const int rows = static_cast<int>(std::ceil(turn * minor / step));
    for (int j = 0; j < rows; ++j) {
        const double middle = turn * (j + 0.5) / rows;
        const int columns = static_cast<int>(std::ceil(turn * (major + minor * std::cos(middle)) / step));
        for (int i = 0; i < columns; ++i) {
            const double theta = turn * (j + 0.25 + 0.5 * random.uniform()) / rows;
            const double phi = turn * (i + 0.25 + 0.5 * random.uniform()) / columns;
            const double c = std::cos(theta), s = std::sin(theta), out = major + minor * c, k2 = c / out;
            cloud.add({out * std::cos(phi), out * std::sin(phi), minor * s}, {c * std::cos(phi), c * std::sin(phi), s},
                      1 / (minor * minor) + k2 * k2);
        }
    }
    return cloud;
}

/// Uniformly random points on the ellipsoid x²/a² + y²/b² + z²/c² = 1 (uniform on the sphere it is stretched from).
inline Cloud ellipsoid_cloud(double a, double b, double c, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    Cloud cloud;
    while (cloud.count() < count) {
        double d[3], s = 0;
        for (double& v : d) v = random.normal(), s += v * v;
        if (s < 1e-6) continue;
        for (double& v : d) v /= std::sqrt(s);
        const double x = a * d[0], y = b * d[1], z = c * d[2];
        const double g[3] = {d[0] / a, d[1] / b, d[2] / c};
        const double w = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]), abc = a * b * c;
        const double gauss = 1 / (abc * abc * w * w * w * w);
        const double mean = (a * a + b * b + c * c - x * x - y * y - z * z) / (2 * abc * abc * w * w * w);
        cloud.add({x, y, z}, {g[0] / w, g[1] / w, g[2] / w}, 4 * mean * mean - 2 * gauss);
    }
    return cloud;
}

inline Cloud sphere_cloud(double radius, std::size_t count, std::uint64_t seed) {
    return ellipsoid_cloud(radius, radius, radius, count, seed);
}

/// Jittered cells on the side of a cylinder about z, open at both ends.
inline Cloud cylinder_cloud(double radius, double height, double step, std::uint64_t seed) {
    Random random(seed);
    Cloud cloud;
    const double turn = 2 * std::numbers::pi;
    const int columns = static_cast<int>(std::ceil(turn * radius / step)), rows = static_cast<int>(height / step);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const double phi = turn * (i + 0.25 + 0.5 * random.uniform()) / columns;
            const double z = step * (j + 0.25 + 0.5 * random.uniform());
            cloud.add({radius * std::cos(phi), radius * std::sin(phi), z}, {std::cos(phi), std::sin(phi), 0},
                      1 / (radius * radius));
        }
    return cloud;
}

/// The integer lattice points [0, side)² at height z.
inline Cloud lattice_cloud(int side, double z) {
    Cloud cloud;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) cloud.add({double(i), double(j), z}, {0, 0, 1}, 0);
    return cloud;
}

/// Root mean square error relative to the truth's root mean square, over the points that have a value.
inline double relative_rmse(const std::vector<double>& value, const std::vector<double>& truth) {
    double error = 0, size = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (!std::isfinite(value[i])) continue;
        error += (value[i] - truth[i]) * (value[i] - truth[i]);
        size += truth[i] * truth[i];
    }
    return size > 0 ? std::sqrt(error / size) : NAN;
}

/// What an std::invalid_argument thrown by the call says; empty where nothing is thrown.
template <class Call>
std::string refusal(Call&& call) {
    try {
        call();
    } catch (const std::invalid_argument& error) { return error.what(); }
    return {};
}

inline double dot3(const double* a, const double* b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace support
