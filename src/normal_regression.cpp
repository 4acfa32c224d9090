#include "normal_regression.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "normal_fit.h"
#include "shape_tensor.h"

namespace gaussmap {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A neighbour in the frame of the element: its place, and the tangential part of its normal. `u`, `v` near 1 at most.
struct Sample {
    double u, v, normal_u, normal_v;
};

/// normal_u = s[0][0] u + s[0][1] v + …, normal_v = s[1][0] u + s[1][1] v + …
struct Regression {
    double s[2][2];
    double shift[2];          ///< the linear part of a fit to values that are 1 everywhere
    double covariance[2][2];  ///< of the linear part for data of unit variance
    double residual;          ///< sum of squares, of both components
    int free;                 ///< of each component
};

/// Least squares by normal equations of unit diagonal, the linear terms last, so that the last two rows of the
/// triangular system hold all that is asked for.
template <int Terms>
bool solve(const std::vector<Sample>& samples, Regression& out) {
    constexpr int sides = 3;
    constexpr double rank_tolerance = 1e-10;
    double a[Terms][Terms] = {}, y[Terms][sides] = {}, total = 0, scale[Terms];
    for (const Sample& p : samples) {
        const double quadratic[5] = {p.u * p.u, p.u * p.v, p.v * p.v, p.u, p.v};
        const double* m = quadratic + 5 - Terms;
        for (int i = 0; i < Terms; ++i) {
            for (int j = 0; j <= i; ++j) a[i][j] += m[i] * m[j];
            y[i][0] += m[i] * p.normal_u, y[i][1] += m[i] * p.normal_v, y[i][2] += m[i];
        }
        total += p.normal_u * p.normal_u + p.normal_v * p.normal_v;
    }
    for (int i = 0; i < Terms; ++i) {
        if (!(a[i][i] > 0)) return false;
        scale[i] = 1 / std::sqrt(a[i][i]);
    }
    for (int i = 0; i < Terms; ++i) {
        for (int j = 0; j <= i; ++j) {
            double value = i == j ? 1 : a[i][j] * scale[i] * scale[j];
            for (int k = 0; k < j; ++k) value -= a[i][k] * a[j][k];
            if (i == j && !(value > rank_tolerance)) return false;
            a[i][j] = i == j ? std::sqrt(value) : value / a[j][j];
        }
        for (double& value : y[i]) value *= scale[i];
        for (int k = 0; k < i; ++k)
            for (int s = 0; s < sides; ++s) y[i][s] -= a[i][k] * y[k][s];
        for (double& value : y[i]) value /= a[i][i];
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
    out.free = static_cast<int>(samples.size()) - Terms;
    return true;
}

/// Standard error of |S|², S the symmetric part: to first order its derivatives by the rows of s are twice the rows of
/// S. The noise of the element's own normal shifts all samples; what noise adds on average comes to it squared.
double standard_error(const Regression& fit, const Symmetric2& s) {
    if (fit.free == 0) return nan;
    const double noise = fit.residual / (2 * fit.free);
    double covariance[2][2], first = 0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) covariance[i][j] = fit.covariance[i][j] + fit.shift[i] * fit.shift[j];
    const double rows[2][2] = {{2 * s.uu, 2 * s.uv}, {2 * s.uv, 2 * s.vv}};
    for (const auto& row : rows)
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) first += row[i] * covariance[i][j] * row[j];
    const double second = 1.5 * noise * (covariance[0][0] + covariance[1][1]);
    return std::sqrt(noise * first + second * second);
}

void sample(const Neighborhood& around, const ElementNormals& normals, const Frame& frame,
            std::vector<Sample>& samples) {
    samples.clear();
    for (std::size_t j = 0; j < around.count; ++j) {
        Vec3 normal = normals.normal[static_cast<std::size_t>(around.index[j])];
        if (!finite(normal)) continue;
        if (normals.align && dot(normal, frame.n) < 0) normal = -normal;
        const Vec3 d = around.offset(j);
        samples.push_back({dot(d, frame.u), dot(d, frame.v), dot(normal, frame.u), dot(normal, frame.v)});
    }
}

}  // namespace

ElementNormals fit_normals(const Elements& elements, int k, CloudNormals method, int degree, const Execution& run) {
    ElementNormals normals;
    normals.align = true;
    normals.normal.resize(elements.count);
    normals.lowered.resize(elements.count);
    for_neighborhoods(elements, k, run, [&](std::size_t /*block*/) {
        return [&, fit = NormalFit(method, degree, static_cast<std::size_t>(k))](std::size_t i,
                                                                                 const Neighborhood& around) mutable {
            NormalFit::Result result;
            fit({&around, 1}, {&result, 1});
            normals.normal[i] = result.normal;
            normals.lowered[i] = result.lowered ? 1 : 0;
        };
    });
    return normals;
}

FittedCurvature normal_regression(const Elements& elements, int k, const ElementNormals& normals, bool error,
                                  const Execution& run) {
    FittedCurvature result;
    result.density.assign(elements.count, nan);
    result.normal = normals.normal;
    result.tensor.resize(elements.count);
    if (error) result.error.assign(elements.count, nan);
    std::vector<std::size_t> lowered_in(block_count(elements.count, Elements::block));
    for_neighborhoods(elements, k, run, [&](std::size_t block) {
        return [&, block, samples = std::vector<Sample>()](std::size_t i, const Neighborhood& around) mutable {
            if (!finite(normals.normal[i])) return;
            const Frame frame = frame_about(normals.normal[i]);
            sample(around, normals, frame, samples);
            Regression fit;
            const bool quadratic = samples.size() > 5 && solve<5>(samples, fit);
            if (!quadratic && (samples.size() < 2 || !solve<2>(samples, fit))) return;
            lowered_in[block] += !quadratic || (!normals.lowered.empty() && normals.lowered[i] != 0);
            const double scale = around.scale;
            const Symmetric2 s = {scale * fit.s[0][0], scale * 0.5 * (fit.s[0][1] + fit.s[1][0]), scale * fit.s[1][1]};
            add_product(result.tensor[i], s.uu, frame.u, frame.u);
            add_product(result.tensor[i], 2 * s.uv, frame.u, frame.v);
            add_product(result.tensor[i], s.vv, frame.v, frame.v);
            result.density[i] = s.uu * s.uu + 2 * s.uv * s.uv + s.vv * s.vv;
            if (error) {
                const double down = 1 / scale;
                result.error[i] = scale * scale * standard_error(fit, {down * s.uu, down * s.uv, down * s.vv});
            }
        };
    });
    for (const std::size_t n : lowered_in) result.lowered += n;
    return result;
}

}  // namespace gaussmap
