// Eigenvalues and eigenvectors of a symmetric 3×3 matrix.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "vec.h"

namespace gaussmap {

/// The upper triangle.
struct Symmetric3 {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

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

}  // namespace gaussmap
