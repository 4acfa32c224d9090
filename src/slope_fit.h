// The slopes of a surface's normals: least squares of the tangential parts of normals against places in the tangent
// plane, by normal equations. The element itself has place 0 and normal part 0, and every fit passes through it, unless
// it is let free.
#pragma once

#include <algorithm>
#include <cmath>

#include "unit_cholesky.h"

namespace gaussmap {

/// normal_u = s[0][0] u + s[0][1] v + …, normal_v = s[1][0] u + s[1][1] v + …
struct Slopes {
    double s[2][2];
    double shift[2];          ///< the linear part of a fit to values that are 1 everywhere
    double covariance[2][2];  ///< of the linear part for data of unit variance
    double residual;          ///< weighted sum of squares, of both components
    int free;                 ///< of each component
};

class SlopeFit {
  public:
    static constexpr int most = 5;     ///< terms: u², uv, v², u, v
    static constexpr int powers = 14;  ///< monomials of degrees 1 to 4: u, v, u², uv, v², u³, …

    /// From sums that were made elsewhere, over `count` data.
    /// \param power   weighted sums of the powers.
    /// \param slope   of the terms times normal_u and times normal_v.
    /// \param square  of normal_u² + normal_v².
    void set(const double (&power)[powers], const double (&slope)[most][2], double square, int count) {
        constexpr int degree[most] = {2, 2, 2, 1, 1}, of_v[most] = {0, 1, 2, 0, 1};
        const auto sum = [&](int d, int j) { return power[d * (d + 1) / 2 + j - 1]; };
        for (int i = 0; i < most; ++i) {
            for (int j = 0; j <= i; ++j) a_[i][j] = sum(degree[i] + degree[j], of_v[i] + of_v[j]);
            y_[i][0] = slope[i][0], y_[i][1] = slope[i][1], y_[i][2] = sum(degree[i], of_v[i]);
        }
        total_ = square;
        count_ = count;
    }

    /// \param u, v  of size 1 at most, about.
    void add(double u, double v, double normal_u, double normal_v, double weight = 1) {
        const double m[most] = {u * u, u * v, v * v, u, v};
        for (int i = 0; i < most; ++i) {
            const double w = weight * m[i];
            for (int j = 0; j <= i; ++j) a_[i][j] += w * m[j];
            y_[i][0] += w * normal_u, y_[i][1] += w * normal_v, y_[i][2] += w;
        }
        total_ += weight * (normal_u * normal_u + normal_v * normal_v);
        ++count_;
    }

    /// Let fits pass by the element, whose own normal is a datum among the others: beside a border it is the worst.
    /// \param own     its weight.
    /// \param weight  of the others together.
    /// \param normal  their weighted sums of normal_u and of normal_v.
    void let_free(double own, double weight, const double (&normal)[2]) {
        // The constant is eliminated from the normal equations: sums of products less products of sums.
        const double each = 1 / (own + weight);
        for (int i = 0; i < most; ++i) {
            const double part = each * y_[i][2];
            for (int j = 0; j <= i; ++j) a_[i][j] -= part * y_[j][2];
            for (int c = 0; c < 2; ++c) y_[i][c] -= part * normal[c];
        }
        for (int i = 0; i < most; ++i) y_[i][2] = 0;
        total_ -= each * (normal[0] * normal[0] + normal[1] * normal[1]);
    }

    int count() const { return count_; }

    /// Fit u, v (Terms = 2), or their squares and product too (5). False where the data do not determine it.
    template <int Terms>
    bool solve(Slopes& out) const {
        // The linear terms are the last, so that the last two rows of the triangular system hold all that is asked for.
        constexpr int first = most - Terms;
        double a[Terms][Terms], y[Terms][sides], scale[Terms], total = total_;
        if (!unit_cholesky(a_, rank_tolerance, a, scale)) return false;
        for (int i = 0; i < Terms; ++i) {
            for (int s = 0; s < sides; ++s) {
                double value = y_[first + i][s] * scale[i];
                for (int k = 0; k < i; ++k) value -= a[i][k] * y[k][s];
                y[i][s] = value / a[i][i];
            }
            total -= y[i][0] * y[i][0] + y[i][1] * y[i][1];
        }
        // [l 0; m r] of the last two unknowns: x_v = y_v / r, x_u = (y_u − m x_v) / l.
        constexpr int u = Terms - 2, v = Terms - 1;
        const double l = a[u][u], m = a[v][u], r = a[v][v];
        double linear[sides][2];
        for (int s = 0; s < sides; ++s) {
            linear[s][1] = y[v][s] / r;
            linear[s][0] = scale[u] * (y[u][s] - m * linear[s][1]) / l;
            linear[s][1] *= scale[v];
        }
        for (int i = 0; i < 2; ++i) out.s[0][i] = linear[0][i], out.s[1][i] = linear[1][i], out.shift[i] = linear[2][i];
        out.covariance[1][1] = scale[v] * scale[v] / (r * r);
        out.covariance[0][1] = out.covariance[1][0] = -scale[u] * scale[v] * m / (l * r * r);
        out.covariance[0][0] = scale[u] * scale[u] * (1 + m * m / (r * r)) / (l * l);
        out.residual = std::max(0.0, total);
        out.free = count_ - Terms;
        return true;
    }

  private:
    static constexpr int sides = 3;
    static constexpr double rank_tolerance = 1e-10;

    double a_[most][most] = {}, y_[most][sides] = {}, total_ = 0;
    int count_ = 0;
};

}  // namespace gaussmap
