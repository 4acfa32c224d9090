// Eigenvalues and eigenvectors of a symmetric 3×3 matrix: all of them, or quickly the one that normals are made of.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "frame.h"
#include "vec.h"

namespace gaussmap {

/// The upper triangle.
struct Symmetric3 {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

inline Vec3 operator*(const Symmetric3& m, Vec3 a) {
    return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
            m.xz * a.x + m.yz * a.y + m.zz * a.z};
}

struct Eigen3 {
    std::array<double, 3> values;  ///< ascending
    std::array<Vec3, 3> vectors;   ///< unit, pairwise orthogonal
};

/// By cyclic Jacobi rotations (Golub and Van Loan, "Matrix Computations", 8.5): small angles between eigenvectors and
/// exact zeros keep their accuracy, which closed formulas lose where eigenvalues meet.
inline Eigen3 eigen(const Symmetric3& m) {
    double a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
    double q[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // rows become the eigenvectors
    const auto rotate = [&](int i, int j) {
        if (a[i][j] == 0) return;
        const double theta = (a[j][j] - a[i][i]) / (2 * a[i][j]);
        const double t = std::copysign(1 / (std::abs(theta) + std::sqrt(theta * theta + 1)), theta);
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        const int k = 3 - i - j;
        a[i][i] -= t * a[i][j];
        a[j][j] += t * a[i][j];
        a[i][j] = a[j][i] = 0;
        const double ik = a[i][k], jk = a[j][k];
        a[i][k] = a[k][i] = c * ik - s * jk;
        a[j][k] = a[k][j] = s * ik + c * jk;
        for (int r = 0; r < 3; ++r) {
            const double x = q[i][r], y = q[j][r];
            q[i][r] = c * x - s * y;
            q[j][r] = s * x + c * y;
        }
    };
    // Convergence is quadratic: about five sweeps reach the last bit; more than twelve are never of use.
    for (int sweep = 0; sweep < 12; ++sweep) {
        const double off = std::abs(a[0][1]) + std::abs(a[0][2]) + std::abs(a[1][2]);
        const double trace = std::abs(a[0][0]) + std::abs(a[1][1]) + std::abs(a[2][2]);
        if (!(off > 1e-17 * trace)) break;
        rotate(0, 1);
        rotate(0, 2);
        rotate(1, 2);
    }
    std::array<int, 3> order = {0, 1, 2};
    const auto sort_pair = [&](int i, int j) {
        if (a[order[j]][order[j]] < a[order[i]][order[i]]) std::swap(order[i], order[j]);
    };
    sort_pair(0, 1);
    sort_pair(1, 2);
    sort_pair(0, 1);
    Eigen3 result;
    for (int i = 0; i < 3; ++i) {
        result.values[i] = a[order[i]][order[i]];
        result.vectors[i] = load(q[order[i]]);
    }
    return result;
}

/// The unit eigenvector of the smallest eigenvalue of a matrix without negative ones, where it stands out: false where
/// it is not found to rounding error, or where the middle eigenvalue is below a hundredth of the largest.
///
/// Newton's steps from 0 climb towards the smallest root of the characteristic polynomial, which is concave there. Each
/// adjugate of M − λ that follows is a step of Rayleigh quotient iteration, whose error is cubed (Parlett, "The
/// Symmetric Eigenvalue Problem", 4.6). The residual then bounds the angle to the eigenvector (Parlett, 11.7.1).
inline bool smallest_eigenvector(const Symmetric3& m, Vec3& vector) {
    const double trace = m.xx + m.yy + m.zz;
    const double minors = m.xx * m.yy - m.xy * m.xy + (m.xx * m.zz - m.xz * m.xz) + (m.yy * m.zz - m.yz * m.yz);
    const double determinant =
        m.xx * (m.yy * m.zz - m.yz * m.yz) - m.xy * (m.xy * m.zz - m.yz * m.xz) + m.xz * (m.xy * m.yz - m.yy * m.xz);
    if (!(minors > 0.01 * trace * trace)) return false;  // λ1/λ2 ≈ minors/trace² where λ0 is small
    double lambda = 0;
    for (int step = 0; step < 2; ++step)
        lambda -= (((lambda - trace) * lambda + minors) * lambda - determinant) /
                  ((3 * lambda - 2 * trace) * lambda + minors);

    const auto adjugate = [&m](double shift) {
        const double xx = m.xx - shift, yy = m.yy - shift, zz = m.zz - shift;
        return Symmetric3{yy * zz - m.yz * m.yz, m.yz * m.xz - m.xy * zz, m.xy * m.yz - yy * m.xz,
                          xx * zz - m.xz * m.xz, m.xy * m.xz - xx * m.yz, xx * yy - m.xy * m.xy};
    };
    const Symmetric3 a = adjugate(lambda);
    vector = {a.xz, a.yz, a.zz};
    if (a.xx > a.zz && a.xx >= a.yy) vector = {a.xx, a.xy, a.xz};
    if (a.yy > a.zz && a.yy > a.xx) vector = {a.xy, a.yy, a.yz};
    lambda = dot(vector, m * vector) / squared(vector);
    vector = unit(adjugate(lambda) * vector);
    const Vec3 image = m * vector;
    lambda = dot(vector, image);
    const double gap = (minors - lambda * (trace - lambda)) / (trace - lambda) - lambda;  // λ1 − λ0, or less
    return length(image - lambda * vector) <= 0x1p-50 * gap;
}

}  // namespace gaussmap
