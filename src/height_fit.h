// Weighted least-squares fits of polynomial height fields, by normal equations kept for all lower degrees at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "vec.h"

namespace gaussmap {

/// Number of monomials uⁱ vʲ with i + j ≤ degree.
constexpr int monomials(int degree) {
    return (degree + 1) * (degree + 2) / 2;
}

/// A fitted height field h(u, v) = Σ c_m · monomial m, in the order 1, u, v, u², uv, v², u³, …
template <int Degree>
struct HeightField {
    std::array<double, monomials(Degree)> c;
    double residual;  ///< weighted sum of the squared residuals
    int free;         ///< data less unknowns
    /// Covariance of the second derivatives h_uu, h_uv, h_vv at the origin for data of unit variance; NaN unless asked
    /// for.
    double covariance[3][3];
};

/// Variance of h_uu² + 2 h_uv² + h_vv² for data of unit variance, to first order.
template <int Degree>
double density_variance(const HeightField<Degree>& field) {
    const double gradient[3] = {4 * field.c[3], 4 * field.c[4], 4 * field.c[5]};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += gradient[i] * gradient[j] * field.covariance[i][j];
    return sum;
}

/// Variance of the second derivatives added up, h_uv twice, for data of unit variance: what noise adds to the density.
template <int Degree>
double shape_variance(const HeightField<Degree>& field) {
    return field.covariance[0][0] + 2 * field.covariance[1][1] + field.covariance[2][2];
}

/// Sums of products of monomials up to a degree and of the heights, over weighted data.
template <int Degree>
class Moments {
  public:
    static constexpr int terms = monomials(Degree);
    static constexpr int stride = (terms + 4) / 4 * 4;  ///< the terms, the height, and padding
    static constexpr int batch = 4;

    void clear() {
        for (auto& row : sum_) std::fill(row, row + stride, 0.0);
        count_ = pending_ = 0;
    }

    void add(double u, double v, double height, double weight = 1) {
        double* m = row_[pending_];
        m[0] = 1, m[1] = u, m[2] = v;
        int at = 3;
        for (int degree = 2; degree <= Degree; ++degree) {
            for (int i = 0; i < degree; ++i, ++at) m[at] = u * m[at - degree];
            m[at] = v * m[at - degree - 1];
            ++at;
        }
        m[terms] = height;
        for (int j = terms + 1; j < stride; ++j) m[j] = 0;
        weight_[pending_] = weight;
        ++count_;
        if (++pending_ == batch) flush();
    }

    int count() const { return count_; }
    /// Sum of the weights, after a solve.
    double weight() const { return sum_[0][0]; }

    /// The height field of a degree ≤ Degree; with `constant` false it passes through the origin.
    /// False where the data do not determine it.
    template <int Lower>
    bool solve(bool constant, HeightField<Lower>& field, bool covariance = false) {
        static_assert(Lower <= Degree);
        flush();
        constexpr int all = monomials(Lower);
        const int skip = constant ? 0 : 1, n = all - skip;
        field.free = count_ - n;
        if (field.free < 0) return false;
        double scale[all], lower[all][all], y[all], x[all];
        for (int i = 0; i < n; ++i) {
            const double square = sum_[i + skip][i + skip];
            if (!(square > 0) || !std::isfinite(square)) return false;
            scale[i] = 1 / std::sqrt(square);
        }
        for (int i = 0; i < n; ++i)
            for (int j = 0; j <= i; ++j) {
                double value = sum_[j + skip][i + skip] * scale[i] * scale[j];
                for (int k = 0; k < j; ++k) value -= lower[i][k] * lower[j][k];
                if (i > j) {
                    lower[i][j] = value / lower[j][j];
                } else {
                    if (!(value > rank_tolerance)) return false;
                    lower[i][i] = std::sqrt(value);
                }
            }
        double explained = 0;
        for (int i = 0; i < n; ++i) {
            double value = sum_[i + skip][terms] * scale[i];
            for (int k = 0; k < i; ++k) value -= lower[i][k] * y[k];
            y[i] = value / lower[i][i];
            explained += y[i] * y[i];
        }
        for (int i = n - 1; i >= 0; --i) {
            double value = y[i];
            for (int k = i + 1; k < n; ++k) value -= lower[k][i] * x[k];
            x[i] = value / lower[i][i];
        }
        field.c[0] = 0;
        for (int i = 0; i < n; ++i) field.c[i + skip] = x[i] * scale[i];
        field.residual = std::max(0.0, sum_[terms][terms] - explained);
        if (covariance)
            second_derivatives(lower, scale, skip, n, field);
        else
            std::fill_n(&field.covariance[0][0], 9, std::numeric_limits<double>::quiet_NaN());
        return true;
    }

  private:
    /// Of unit-diagonal normal equations: a monomial that the others match to its root is not determined.
    static constexpr double rank_tolerance = 1e-6;

    template <int Lower, int N>
    static void second_derivatives(const double (&lower)[N][N], const double* scale, int skip, int n,
                                   HeightField<Lower>& field) {
        // Columns 3 … 5 of the inverse's root: the covariance is their product.
        double column[3][N];
        for (int q = 0; q < 3; ++q) {
            const int at = 3 + q - skip;
            for (int i = 0; i < at; ++i) column[q][i] = 0;
            for (int i = at; i < n; ++i) {
                double value = i == at ? 1 : 0;
                for (int k = at; k < i; ++k) value -= lower[i][k] * column[q][k];
                column[q][i] = value / lower[i][i];
            }
        }
        constexpr double factor[3] = {2, 1, 2};
        for (int p = 0; p < 3; ++p)
            for (int q = 0; q < 3; ++q) {
                double sum = 0;
                for (int i = 3 - skip; i < n; ++i) sum += column[p][i] * column[q][i];
                field.covariance[p][q] = sum * scale[3 + p - skip] * scale[3 + q - skip] * factor[p] * factor[q];
            }
    }

    /// Add the pending rows: four at a time, so that the sums are loaded and stored once for them.
    void flush() {
        if (pending_ == 0) return;
        for (; pending_ < batch; ++pending_) {
            weight_[pending_] = 0;
            std::fill(row_[pending_], row_[pending_] + stride, 0.0);
        }
        for (int i = 0; i <= terms; ++i) {
            const double a = weight_[0] * row_[0][i], b = weight_[1] * row_[1][i], c = weight_[2] * row_[2][i],
                         d = weight_[3] * row_[3][i];
            for (int j = i / 4 * 4; j < stride; ++j)
                sum_[i][j] += (a * row_[0][j] + b * row_[1][j]) + (c * row_[2][j] + d * row_[3][j]);
        }
        pending_ = 0;
    }

    alignas(32) double sum_[terms + 1][stride];
    alignas(32) double row_[batch][stride];
    double weight_[batch];
    int count_ = 0, pending_ = 0;
};

}  // namespace gaussmap
