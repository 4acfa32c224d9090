// The surface that algebraic spheres make, one about each place in space: Guennebaud and Gross, "Algebraic Point Set
// Surfaces", 2007. The sphere of a place x is the function c + l·y + q |y|² of y whose gradients agree best with the
// normals of the samples and whose values there are least, with weights that depend on x. Its value at x is the
// surface's potential; the shape operator is that of the potential's level set through x, second derivatives of the
// weights included. On a sphere that is exact at any scale, and so it nearly is along circles of other surfaces.
#pragma once

#include <algorithm>
#include <cmath>

#include "frame.h"
#include "shape_tensor.h"
#include "vec.h"

namespace gaussmap {

/// A function near a place, to the second order.
struct SecondOrder {
    double value = 0;
    Vec3 gradient = {0, 0, 0};
    Symmetric3 hessian;
};

inline SecondOrder operator+(const SecondOrder& a, const SecondOrder& b) {
    SecondOrder sum = {a.value + b.value, a.gradient + b.gradient, a.hessian};
    add(sum.hessian, 1, b.hessian);
    return sum;
}
inline SecondOrder operator*(double s, const SecondOrder& a) {
    SecondOrder scaled = {s * a.value, s * a.gradient, {}};
    add(scaled.hessian, s, a.hessian);
    return scaled;
}
inline SecondOrder operator-(const SecondOrder& a, const SecondOrder& b) {
    return a + -1.0 * b;
}
inline SecondOrder operator*(const SecondOrder& a, const SecondOrder& b) {
    SecondOrder product = {a.value * b.value, a.value * b.gradient + b.value * a.gradient, {}};
    add(product.hessian, a.value, b.hessian);
    add(product.hessian, b.value, a.hessian);
    add_product(product.hessian, 2, a.gradient, b.gradient);
    return product;
}
inline SecondOrder inverse(const SecondOrder& a) {
    const double v = 1 / a.value;
    SecondOrder result = {v, -v * v * a.gradient, {}};
    add(result.hessian, -v * v, a.hessian);
    add_product(result.hessian, 2 * v * v * v, a.gradient, a.gradient);
    return result;
}

/// The level set through the place: its unit normal and its shape operator; and how far along the normal the surface
/// is, to the first order.
struct LevelSet {
    Vec3 normal;
    Symmetric3 tensor;
    double height;
};

/// Sums over the samples about a place, at differences p from it in units of the window, with normals n. A sample's
/// weight is w = k s², s = 1 − |p|² and k its own; when the place moves it changes by 4 k s p, and that by 8 k ppᵀ − 4
/// k s.
struct SphereSums {
    static constexpr int terms = 9;   ///< 1, p, n, |p|², p·n
    static constexpr int parts = 11;  ///< of each: k s², k s p, k s, and k times xx xy xz yy yz zz of p
    double sum[terms][parts] = {};

    void add(Vec3 p, Vec3 n, double k) {
        const double term[terms] = {1, p.x, p.y, p.z, n.x, n.y, n.z, squared(p), dot(p, n)}, s = 1 - squared(p);
        const double part[parts] = {s * s,     s * p.x,   s * p.y,   s * p.z,   s,        p.x * p.x,
                                    p.x * p.y, p.x * p.z, p.y * p.y, p.y * p.z, p.z * p.z};
        for (int t = 0; t < terms; ++t)
            for (int i = 0; i < parts; ++i) sum[t][i] += k * term[t] * part[i];
    }

    SecondOrder operator[](int term) const {
        const double* of = sum[term];
        const double shift = 4 * of[4];
        return {of[0],
                4 * Vec3{of[1], of[2], of[3]},
                {8 * of[5] - shift, 8 * of[6], 8 * of[7], 8 * of[8] - shift, 8 * of[9], 8 * of[10] - shift}};
    }

    /// Mean place of the samples.
    Vec3 middle() const { return 1 / sum[0][0] * Vec3{sum[1][0], sum[2][0], sum[3][0]}; }

    /// Not finite where the samples are too few.
    LevelSet level_set() const {
        const SecondOrder each = inverse((*this)[0]);
        SecondOrder p[3], n[3];
        for (int c = 0; c < 3; ++c) p[c] = each * (*this)[1 + c], n[c] = each * (*this)[4 + c];
        const SecondOrder pp = each * (*this)[7], pn = each * (*this)[8];
        // q = (⟨p·n⟩ − ⟨p⟩·⟨n⟩) / 2 (⟨p·p⟩ − ⟨p⟩·⟨p⟩), l = ⟨n⟩ − 2 q ⟨p⟩, c = −l·⟨p⟩ − q ⟨p·p⟩
        const SecondOrder square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        const SecondOrder product = p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
        const SecondOrder quadratic = 0.5 * ((pn - product) * inverse(pp - square));
        const SecondOrder constant = quadratic * (2.0 * square - pp) - product;
        Vec3 gradient = constant.gradient;
        Symmetric3 hessian = constant.hessian;
        constexpr Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int c = 0; c < 3; ++c) {
            const SecondOrder linear = n[c] - 2.0 * (quadratic * p[c]);
            gradient = gradient + linear.value * axes[c];
            add_product(hessian, 2, axes[c], linear.gradient);
            add_product(hessian, 2 * quadratic.value, axes[c], axes[c]);
        }
        const double size = length(gradient);
        LevelSet found = {1 / size * gradient, {}, -constant.value / size};
        // P H P / |∇|, P the projection along the normal.
        const Vec3 along = gaussmap::product(hessian, found.normal);
        add_product(hessian, -2, found.normal, along);
        add_product(hessian, dot(found.normal, along), found.normal, found.normal);
        gaussmap::add(found.tensor, 1 / size, hessian);
        mix_in_slopes(p, n, size, found);
        return found;
    }

  private:
    /// Beside a border the mean place of the samples does not keep up with the place, and the second derivatives of the
    /// potential are too flat, where the surface is no sphere, by a part that no smaller window mends. The slope of the
    /// mean normal over the mean place, ⟨n⟩′ ⟨p⟩′⁻¹, is exact there for normals that are linear over the places, but
    /// errs more where they are not, and has more noise. The farther the mean place is away, the more the latter
    /// counts.
    static void mix_in_slopes(const SecondOrder (&place)[3], const SecondOrder (&normal)[3], double size,
                              LevelSet& found) {
        constexpr double all_slope = 0.6;  // 0.29 at the border of a half disc
        const Vec3 middle = {place[0].value, place[1].value, place[2].value};
        const double away = length(middle - dot(middle, found.normal) * found.normal);
        const double part = std::min(1.0, away / all_slope);
        const Frame frame = frame_about(found.normal);
        const Vec3 axes[2] = {frame.u, frame.v};
        const auto change = [&](const SecondOrder(&of)[3], int a, int b) {
            return dot(axes[a],
                       Vec3{dot(of[0].gradient, axes[b]), dot(of[1].gradient, axes[b]), dot(of[2].gradient, axes[b])});
        };
        double n[2][2], m[2][2];
        for (int a = 0; a < 2; ++a)
            for (int b = 0; b < 2; ++b) n[a][b] = change(normal, a, b), m[a][b] = change(place, a, b);
        const double by = 1 / (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
        const double uu = by * (n[0][0] * m[1][1] - n[0][1] * m[1][0]),
                     uv = by * (n[0][1] * m[0][0] - n[0][0] * m[0][1]),
                     vu = by * (n[1][0] * m[1][1] - n[1][1] * m[1][0]),
                     vv = by * (n[1][1] * m[0][0] - n[1][0] * m[0][1]);
        Symmetric3 mixed;
        gaussmap::add(mixed, 1 - part, found.tensor);
        gaussmap::add(mixed, part / size, in_plane(frame, uu, 0.5 * (uv + vu), vv));
        found.tensor = mixed;
    }
};

}  // namespace gaussmap
