// Every analytic surface, small, with what is known about it by other means: topology, its equation, and a local
// parametrisation about any of its points that owes nothing to the library.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "gaussmap/surfaces.h"

namespace surface_cases {

using gaussmap::Surface;
using gaussmap::SurfaceOptions;

struct Vec {
    double x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(Vec a, Vec b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(double s, Vec a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline double dot(Vec a, Vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline double norm(Vec a) {
    return std::sqrt(dot(a, a));
}
inline Vec unit(Vec a) {
    return (1 / norm(a)) * a;
}
inline Vec cross(Vec a, Vec b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec vec(const std::vector<double>& flat, std::size_t i) {
    return {flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]};
}
inline Vec across(Vec n) {
    return unit(cross(n, std::abs(n.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0}));
}

/// Position at parameters (u, v), the vertex itself at (0, 0).
using Patch = std::function<Vec(double, double)>;

struct Case {
    std::string name;
    std::function<Surface(const SurfaceOptions&)> make;
    bool closed;
    int euler;                                   ///< vertices − edges + faces
    double total_gauss;                          ///< ∫ K dA; NaN: not known in closed form
    std::function<double(Vec)> equation;         ///< zero on the surface, its slope about 1
    std::function<Patch(Vec, Vec)> patch_about;  ///< from position and outward normal
};

/// ((2 + cos 2t) cos 3t, …) and the like for complex t too, whence exact derivatives by a complex step.
template <class T>
struct Triple {
    T x, y, z;
};
template <class T>
Triple<T> trefoil(T t) {
    using std::cos, std::sin;
    return {(1.0 + 0.4 * cos(3.0 * t)) * cos(2.0 * t), (1.0 + 0.4 * cos(3.0 * t)) * sin(2.0 * t), 0.4 * sin(3.0 * t)};
}
template <class T>
Triple<T> figure_eight(T t) {
    using std::cos, std::sin;
    return {0.5 * (2.0 + cos(2.0 * t)) * cos(3.0 * t), 0.5 * (2.0 + cos(2.0 * t)) * sin(3.0 * t), 0.5 * sin(4.0 * t)};
}

template <class Curve>
Vec at(const Curve& curve, double t) {
    const auto p = curve(t);
    return {p.x, p.y, p.z};
}
template <class Curve>
Vec derivative(const Curve& curve, double t) {
    const auto p = curve(std::complex<double>(t, 1e-40));
    return {p.x.imag() * 1e40, p.y.imag() * 1e40, p.z.imag() * 1e40};
}

/// Parameter of the point of the curve nearest to p: scan, then Gauss–Newton.
template <class Curve>
double nearest_parameter(const Curve& curve, Vec p) {
    double best = 0;
    for (int i = 1; i < 1000; ++i) {
        const double t = 2 * std::numbers::pi * i / 1000;
        if (norm(at(curve, t) - p) < norm(at(curve, best) - p)) best = t;
    }
    for (int i = 0; i < 50; ++i) {
        const Vec d = derivative(curve, best);
        best += dot(p - at(curve, best), d) / dot(d, d);
    }
    return best;
}

/// Distance from the tube and a patch of it. With h = p·T(t + u) taken away and normalised, any perpendicular of the
/// tangent at t gives a perpendicular at t + u.
template <class Curve>
Case tube(std::string name, std::function<Surface(const SurfaceOptions&)> make, Curve curve, double radius) {
    return {std::move(name),
            std::move(make),
            true,
            0,
            0,
            [=](Vec p) { return norm(p - at(curve, nearest_parameter(curve, p))) - radius; },
            [=](Vec p, Vec n) -> Patch {
                const double t = nearest_parameter(curve, p - radius * n);
                const Vec m = cross(unit(derivative(curve, t)), n);
                return [=](double u, double v) {
                    const Vec tangent = unit(derivative(curve, t + u));
                    const Vec along = std::cos(v) * n + std::sin(v) * m;
                    return at(curve, t + u) + radius * unit(along - dot(along, tangent) * tangent);
                };
            }};
}

/// Surfaces that are a function of the direction: `place(d)` is the point, `direction(p)` goes back.
inline Case star(std::string name, std::function<Surface(const SurfaceOptions&)> make, std::function<Vec(Vec)> place,
                 std::function<Vec(Vec)> direction) {
    return {std::move(name),
            std::move(make),
            true,
            2,
            4 * std::numbers::pi,
            [=](Vec p) { return norm(p - place(direction(p))); },
            [=](Vec p, Vec) -> Patch {
                const Vec d = direction(p), e = across(d), f = cross(d, e);
                return [=](double u, double v) { return place(unit(d + u * e + v * f)); };
            }};
}

inline std::vector<Case> round_cases() {
    return {
        star(
            "sphere", [](const SurfaceOptions& o) { return gaussmap::sphere(4, 2, o); }, [](Vec d) { return 2 * d; },
            [](Vec p) { return unit(p); }),
        star(
            "ellipsoid", [](const SurfaceOptions& o) { return gaussmap::ellipsoid(1, 2, 0.75, 4, o); },
            [](Vec d) {
                return Vec{d.x, 2 * d.y, 0.75 * d.z};
            },
            [](Vec p) {
                return unit(Vec{p.x, p.y / 2, p.z / 0.75});
            }),
        star(
            "bumpy_sphere", [](const SurfaceOptions& o) { return gaussmap::bumpy_sphere(1.5, 0.2, 4, 5, o); },
            [](Vec d) { return (1.5 * (1 + 0.2 * std::sin(4 * d.x) * std::sin(4 * d.y) * std::sin(4 * d.z))) * d; },
            [](Vec p) { return unit(p); }),
        {"torus", [](const SurfaceOptions& o) { return gaussmap::torus(1, 0.5, 60, 40, o); }, true, 0, 0,
         [](Vec p) { return std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.5; },
         [](Vec p, Vec) -> Patch {
             const double s = std::atan2(p.y, p.x), t = std::atan2(p.z, std::hypot(p.x, p.y) - 1);
             return [=](double u, double v) {
                 const double r = 1 + 0.5 * std::cos(t + v);
                 return Vec{r * std::cos(s + u), r * std::sin(s + u), 0.5 * std::sin(t + v)};
             };
         }},
        tube(
            "torus_knot", [](const SurfaceOptions& o) { return gaussmap::torus_knot(2, 3, 1, 0.4, 0.12, 300, 24, o); },
            [](auto t) { return trefoil(t); }, 0.12),
        tube(
            "figure_eight_knot",
            [](const SurfaceOptions& o) { return gaussmap::figure_eight_knot(0.5, 0.1, 400, 24, o); },
            [](auto t) { return figure_eight(t); }, 0.1),
    };
}

inline std::vector<Case> open_cases() {
    const auto about_z = [](Vec p, auto radius) -> Patch {
        const double s = std::atan2(p.y, p.x);
        return [=](double u, double v) {
            return Vec{radius(p.z + v) * std::cos(s + u), radius(p.z + v) * std::sin(s + u), p.z + v};
        };
    };
    const auto height = [](double x, double y) {
        return 0.3 * std::cos(2 * std::numbers::pi * x / 1.5) * std::cos(2 * std::numbers::pi * y / 1.5);
    };
    const auto neck = [](double z) { return 0.7 * std::cosh(z / 0.7); };
    return {
        {"catenoid", [](const SurfaceOptions& o) { return gaussmap::catenoid(0.7, 2, 60, 30, o); }, false, 0,
         -4 * std::numbers::pi * std::tanh(1 / 0.7), [=](Vec p) { return std::hypot(p.x, p.y) - neck(p.z); },
         [=](Vec p, Vec) { return about_z(p, neck); }},
        {"cylinder", [](const SurfaceOptions& o) { return gaussmap::cylinder(0.8, 3, 40, 20, o); }, false, 0, 0,
         [](Vec p) { return std::hypot(p.x, p.y) - 0.8; },
         [=](Vec p, Vec) { return about_z(p, [](double) { return 0.8; }); }},
        {"plane", [](const SurfaceOptions& o) { return gaussmap::plane(2, 3, 20, 30, o); }, false, 1, 0,
         [](Vec p) { return p.z; },
         [](Vec p, Vec) -> Patch { return [=](double u, double v) {
                                       return Vec{p.x + u, p.y + v, 0};
                                   }; }},
        {"waves", [](const SurfaceOptions& o) { return gaussmap::waves(3, 2, 0.3, 1.5, 60, 40, o); }, false, 1, NAN,
         [=](Vec p) { return p.z - height(p.x, p.y); },
         [=](Vec p, Vec) -> Patch {
             return [=](double u, double v) { return Vec{p.x + u, p.y + v, height(p.x + u, p.y + v)}; };
         }},
    };
}

inline std::vector<Case> all_cases() {
    std::vector<Case> all = round_cases();
    for (Case& c : open_cases()) all.push_back(std::move(c));
    return all;
}

/// Normal and principal curvatures of a patch at (0, 0), from its fundamental forms by central differences of order 4.
struct Measured {
    Vec normal;
    double k1, k2;
};
inline Measured measure(const Patch& patch, Vec outward) {
    constexpr double h = 1e-3, first[4] = {1, -8, 8, -1}, second[4] = {-1, 16, 16, -1};
    constexpr int steps[4] = {-2, -1, 1, 2};
    const Vec p = patch(0, 0);
    Vec pu, pv, puu = -30 * p, pvv = -30 * p, puv;
    for (int i = 0; i < 4; ++i) {
        const double a = steps[i] * h;
        const Vec along_u = patch(a, 0), along_v = patch(0, a);
        pu = pu + first[i] * along_u, pv = pv + first[i] * along_v;
        puu = puu + second[i] * along_u, pvv = pvv + second[i] * along_v;
        for (int j = 0; j < 4; ++j) puv = puv + (first[i] * first[j]) * patch(a, steps[j] * h);
    }
    pu = (1 / (12 * h)) * pu, pv = (1 / (12 * h)) * pv;
    puu = (1 / (12 * h * h)) * puu, pvv = (1 / (12 * h * h)) * pvv, puv = (1 / (144 * h * h)) * puv;
    Vec n = unit(cross(pu, pv));
    if (dot(n, outward) < 0) n = -1.0 * n;
    const double E = dot(pu, pu), F = dot(pu, pv), G = dot(pv, pv);
    const double L = -dot(puu, n), M = -dot(puv, n), N = -dot(pvv, n);  // a sphere bends to +1/r
    const double area = E * G - F * F, H = (E * N - 2 * F * M + G * L) / (2 * area), K = (L * N - M * M) / area;
    const double apart = std::sqrt(std::max(0.0, H * H - K));
    return {n, H + apart, H - apart};
}

}  // namespace surface_cases
