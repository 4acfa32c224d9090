// The triangular factor of small normal equations, scaled to a unit diagonal.
#pragma once

#include <cmath>

namespace gaussmap {

/// Of the last N rows and columns of the lower triangle `a`: factor · factorᵀ = diag(scale) a diag(scale).
/// False where the others match an unknown to the root of the tolerance: it is not determined.
template <int N, int Most>
bool unit_cholesky(const double (&a)[Most][Most], double tolerance, double (&factor)[N][N], double (&scale)[N]) {
    constexpr int first = Most - N;
    for (int i = 0; i < N; ++i) {
        if (!(a[first + i][first + i] > 0)) return false;
        scale[i] = 1 / std::sqrt(a[first + i][first + i]);
        for (int j = 0; j <= i; ++j) {
            double value = i == j ? 1 : a[first + i][first + j] * scale[i] * scale[j];
            for (int k = 0; k < j; ++k) value -= factor[i][k] * factor[j][k];
            if (i == j && !(value > tolerance)) return false;
            factor[i][j] = i == j ? std::sqrt(value) : value / factor[j][j];
        }
    }
    return true;
}

}  // namespace gaussmap
