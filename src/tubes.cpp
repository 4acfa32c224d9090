// Tubes about closed curves: the torus knots and the figure-eight knot.
//
// At angle θ of the unit normal N(t, θ) of the curve, the tube of radius a has k1 = 1/a and k2 = −κ/(1 − aκ), where
// κ = N·γ″/|γ′|² is the curvature c of the curve times the cosine of N's angle from the principal normal. The principal
// normal itself is not needed, so points where c vanishes are nothing special.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "analytic.h"
#include "arguments.h"
#include "gaussmap/surfaces.h"
#include "grid.h"

namespace gaussmap {
namespace {

constexpr double turn = 2 * std::numbers::pi;

/// A point of a curve with its derivatives.
struct CurvePoint {
    Vec3 position, first, second;
};

/// A function of one variable with its derivatives.
struct Jet {
    double value, first, second;
};

/// (ρ(t) cos mt, ρ(t) sin mt, h(t)).
CurvePoint about_axis(const Jet& rho, double m, const Jet& h, double t) {
    const Vec3 radial{std::cos(m * t), std::sin(m * t), 0}, tangential{-radial.y, radial.x, 0}, up{0, 0, 1};
    return {rho.value * radial + h.value * up, rho.first * radial + (m * rho.value) * tangential + h.first * up,
            (rho.second - m * m * rho.value) * radial + (2 * m * rho.first) * tangential + h.second * up};
}

/// offset + a cos ft.
Jet cosine(double offset, double a, double f, double t) {
    const double c = a * std::cos(f * t), s = a * std::sin(f * t);
    return {offset + c, -f * s, -f * f * c};
}

/// a sin ft.
Jet sine(double a, double f, double t) {
    const double c = a * std::cos(f * t), s = a * std::sin(f * t);
    return {s, f * c, -f * f * s};
}

/// Unit vector r, perpendicular to the unit vector `from`, turned by the smallest rotation that takes `from` to `to`.
Vec3 transported(Vec3 r, Vec3 from, Vec3 to) {
    const double half = 1 + dot(from, to);
    if (half < 1e-12) return perpendicular(to);  // opposite: every perpendicular is as near
    const Vec3 turned = r - (dot(r, to) / half) * (from + to);
    return normalized(turned - dot(turned, to) * to);
}

/// A frame that turns about the curve as little as it can, from one row of the grid to the next.
struct Frame {
    std::vector<Vec3> tangent, right;  ///< a row
    double closing = 0;                ///< angle about the tangent by which it misses itself after one turn
};

template <class Curve>
Frame frame_along(const Curve& curve, int rows) {
    Frame frame;
    for (int i = 0; i < rows; ++i) frame.tangent.push_back(normalized(curve(turn * i / rows).first));
    frame.right.push_back(perpendicular(frame.tangent[0]));
    for (int i = 1; i < rows; ++i)
        frame.right.push_back(transported(frame.right[i - 1], frame.tangent[i - 1], frame.tangent[i]));
    const Vec3 last = transported(frame.right.back(), frame.tangent.back(), frame.tangent[0]);
    const Vec3 right = frame.right[0], up = cross(right, frame.tangent[0]);
    frame.closing = std::atan2(dot(last, up), dot(last, right));
    return frame;
}

/// Largest curvature of a curve over its `period`.
template <class Curve>
double largest_curvature(const Curve& curve, double period) {
    constexpr int samples = 4096;
    double largest = 0;
    for (int i = 0; i < samples; ++i) {
        const CurvePoint at = curve(period * i / samples);
        const double speed = length(at.first);
        largest = std::max(largest, length(cross(at.first, at.second)) / (speed * speed * speed));
    }
    return largest;
}

/// Curve is CurvePoint(double t) of period 2π, its curvature having the given period.
template <class Curve>
Surface tube_about(const char* function, const Curve& curve, double period, double radius, int around, int across,
                   const SurfaceOptions& options) {
    require_positive(function, "tube", radius);
    const Grid grid{around, across};
    check_grid(function, grid);
    check_options(function, options);
    const double tightest = 1 / largest_curvature(curve, period);
    require(radius < tightest, function, "tube", radius,
            "be less than the curve's smallest radius of curvature, " + shown(tightest));
    const Frame frame = frame_along(curve, around);
    return grid_surface(grid, options, [&](const GridPoint& at) {
        const CurvePoint on = curve(turn * at.u);
        const Vec3 tangent = normalized(on.first);
        const Vec3 right = transported(frame.right[at.row], frame.tangent[at.row], tangent);
        const Vec3 up = cross(right, tangent);
        // The frame's misfit after one turn is spread evenly over it.
        const double angle = turn * at.v - frame.closing * at.u;
        const Vec3 normal = normalized(std::cos(angle) * right + std::sin(angle) * up);
        const double bend = dot(normal, on.second) / squared(on.first);
        return SurfacePoint{on.position + radius * normal, normal, 1 / radius, -bend / (1 - radius * bend)};
    });
}

}  // namespace

Surface torus_knot(int p, int q, double major, double minor, double tube, int around, int across,
                   const SurfaceOptions& options) {
    require(p >= 1, "torus_knot", "p", p, "be at least 1");
    require(q >= 1, "torus_knot", "q", q, "be at least 1");
    require(std::gcd(p, q) == 1, "torus_knot", "q", q, "have no common divisor with p = " + shown(p));
    require_positive("torus_knot", "major", major);
    require_positive("torus_knot", "minor", minor);
    require(minor < major, "torus_knot", "minor", minor, "be less than major = " + shown(major));
    const auto knot = [&](double t) { return about_axis(cosine(major, minor, q, t), p, sine(minor, q, t), t); };
    return tube_about("torus_knot", knot, turn / q, tube, around, across, options);
}

Surface figure_eight_knot(double scale, double tube, int around, int across, const SurfaceOptions& options) {
    require_positive("figure_eight_knot", "scale", scale);
    const auto knot = [&](double t) { return about_axis(cosine(2 * scale, scale, 2, t), 3, sine(scale, 4, t), t); };
    return tube_about("figure_eight_knot", knot, turn / 2, tube, around, across, options);
}

}  // namespace gaussmap
