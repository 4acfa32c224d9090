// Normals of cloud points: the smallest principal direction of the neighbours (Hoppe et al. 1992), and above it the
// normal of a polynomial height field fitted to them (Cazals and Pouget 2005).
#include "normal_fit.h"

#include <algorithm>
#include <array>
#include <limits>

#include "eigen3.h"

namespace gaussmap {
namespace {

/// Neighbours closer to a line than the root of this, relative to their spread, span no plane.
constexpr double line_tolerance = 1e-13;
/// A monomial that the others match this closely on the neighbours is not determined by them.
constexpr double rank_tolerance = 1e-4;
/// Above this the normal equations, whose condition is that of the fit squared, are as good as reflections.
constexpr double normal_equations_tolerance = 1e-2;

const Vec3 undefined = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::quiet_NaN()};

constexpr Two one = {1, 1};

/// The weights of the neighbours; the point itself weighs 1.
struct Even {
    GAUSSMAP_LANES Four operator()(Four /*squared*/) const { return {one, one}; }
};
struct Smooth {
    double over_h_squared;
    GAUSSMAP_LANES Four operator()(Four squared) const {
        const Four rest = Four{one, one} - squared * over_h_squared;
        return rest * rest;
    }
};

/// Second moments of the point and its neighbours about their mean.
template <class Weight>
Symmetric3 moments(const Neighborhood& neighborhood, const Weight& weight) {
    Four w, x, y, z, xx, xy, xz, yy, yz, zz;
    for (std::size_t j = 0; j < neighborhood.count; j += lanes) {
        const Four dx = load_four(&neighborhood.x[j]), dy = load_four(&neighborhood.y[j]);
        const Four dz = load_four(&neighborhood.z[j]), s = weight(dx * dx + dy * dy + dz * dz);
        const Four wx = s * dx, wy = s * dy, wz = s * dz;
        w += s, x += wx, y += wy, z += wz;
        xx += wx * dx, xy += wx * dy, xz += wx * dz;
        yy += wy * dy, yz += wy * dz, zz += wz * dz;
    }
    // What fills the arrays up weighs 1 at the centre, and so does the centre.
    const double filled = static_cast<double>(padded(neighborhood.count) - neighborhood.count);
    const double all = total(w) - filled + 1;
    const Vec3 sum = {total(x), total(y), total(z)}, mean = (1 / all) * sum;
    return {total(xx) - sum.x * mean.x, total(xy) - sum.x * mean.y, total(xz) - sum.x * mean.z,
            total(yy) - sum.y * mean.y, total(yz) - sum.y * mean.z, total(zz) - sum.z * mean.z};
}

/// The same from differences to the mean, which cancel nothing, one after the other.
template <class Weight>
Symmetric3 careful_moments(const Neighborhood& neighborhood, const Weight& weight) {
    const auto weight_of = [&](Vec3 d) { return weight(Four{squared(d) * one, one}).low[0]; };
    Vec3 mean;
    double all = 1;
    for (std::size_t j = 0; j < neighborhood.count; ++j) {
        const Vec3 d = neighborhood.offset(j);
        all += weight_of(d);
        mean = mean + weight_of(d) * d;
    }
    mean = 1 / all * mean;
    Symmetric3 m = {mean.x * mean.x, mean.x * mean.y, mean.x * mean.z,
                    mean.y * mean.y, mean.y * mean.z, mean.z * mean.z};
    for (std::size_t j = 0; j < neighborhood.count; ++j) {
        const double w = weight_of(neighborhood.offset(j));
        const Vec3 d = neighborhood.offset(j) - mean, wd = w * d;
        m.xx += wd.x * d.x, m.xy += wd.x * d.y, m.xz += wd.x * d.z;
        m.yy += wd.y * d.y, m.yz += wd.y * d.z, m.zz += wd.z * d.z;
    }
    return m;
}

template <class Weight>
Vec3 principal_normal(const Neighborhood& neighborhood, const Weight& weight) {
    Vec3 normal;
    if (smallest_eigenvector(moments(neighborhood, weight), normal)) return upward(normal);
    const Eigen3 principal = eigen(careful_moments(neighborhood, weight));
    if (!(principal.values[1] > line_tolerance * principal.values[2])) return undefined;
    return upward(principal.vectors[0]);
}

/// Powers i, j of the monomial uⁱ vʲ in column c of a jet: u v u² uv v² u³ …
constexpr std::array<int, 2> powers(int c) {
    int degree = 1;
    for (; c > degree; ++degree) c -= degree + 1;
    return {degree - c, c};
}
constexpr int column_of(int i, int j) {
    return (i + j) * (i + j + 1) / 2 + j - 1;
}

/// Products of monomials are monomials of up to twice the degree, of which each sum is made once, of two columns.
template <int Degree>
struct Sums {
    static constexpr int count = column_of(0, 2 * Degree) + 1;
    static constexpr auto factors = [] {
        std::array<std::array<int, 2>, count> result{};
        for (int s = 2; s < count; ++s) {
            const auto [i, j] = powers(s);
            const int half = (i + j) / 2, first_i = std::min(i, half), first_j = half - first_i;
            result[s] = {column_of(first_i, first_j), column_of(i - first_i, j - first_j)};
        }
        return result;
    }();
};

}  // namespace

Vec3 principal_normal(const Neighborhood& neighborhood, bool weighted) {
    if (!weighted) return principal_normal(neighborhood, Even());
    double farthest = 0;
    for (std::size_t j = 0; j < neighborhood.count; ++j) farthest = std::max(farthest, squared(neighborhood.offset(j)));
    const auto k = static_cast<double>(neighborhood.count);
    return principal_normal(neighborhood, Smooth{farthest > 0 ? k / (farthest * (k + 1)) : 0});
}

template <int Degree>
void Jet<Degree>::fill(const Neighborhood& neighborhood, const Frame& frame) {
    stride_ = padded(neighborhood.count);
    double* const c = columns_.data();
    for (std::size_t j = 0; j < stride_; j += lanes) {
        const Four x = load_four(&neighborhood.x[j]), y = load_four(&neighborhood.y[j]);
        const Four z = load_four(&neighborhood.z[j]);
        const Four u = x * frame.u.x + y * frame.u.y + z * frame.u.z;
        const Four v = x * frame.v.x + y * frame.v.y + z * frame.v.z;
        Four monomial[unknowns] = {u, v};
        for (int degree = 2, at = 2; degree <= Degree; ++degree, ++at) {
            for (int i = 0; i < degree; ++i, ++at) monomial[at] = u * monomial[at - degree];
            monomial[at] = v * monomial[at - degree - 1];
        }
        for (int at = 0; at < unknowns; ++at) store_four(c + at * stride_ + j, monomial[at]);
        store_four(c + unknowns * stride_ + j, x * frame.n.x + y * frame.n.y + z * frame.n.z);
    }
}

/// By L D Lᵀ, the coefficients of u and v last so that no substitution is needed beyond them.
template <int Degree>
bool Jet<Degree>::solve_normal_equations(std::size_t slots, double& cu, double& cv) const {
    const auto column = [&](int c) { return columns_.data() + static_cast<std::size_t>(c) * stride_; };
    std::array<double, Sums<Degree>::count> sum;
    for (int s = 2; s < Sums<Degree>::count; ++s)
        sum[s] = product(column(Sums<Degree>::factors[s][0]), column(Sums<Degree>::factors[s][1]), slots);
    double a[unknowns][unknowns], right[unknowns], largest = 0;
    for (int r = 0; r < unknowns; ++r) {
        const auto [ri, rj] = powers(unknowns - 1 - r);
        for (int c = 0; c <= r; ++c) {
            const auto [ci, cj] = powers(unknowns - 1 - c);
            a[r][c] = sum[column_of(ri + ci, rj + cj)];
        }
        largest = std::max(largest, a[r][r]);
        right[r] = product(column(unknowns - 1 - r), column(unknowns), slots);
    }
    const double least = normal_equations_tolerance * normal_equations_tolerance * largest;
    for (int p = 0; p < unknowns; ++p) {
        if (!(a[p][p] > least)) return false;
        const double inverse = 1 / a[p][p];
        for (int r = p + 1; r < unknowns; ++r) {
            const double factor = a[r][p] * inverse;
            for (int c = p + 1; c <= r; ++c) a[r][c] -= factor * a[c][p];
            right[r] -= factor * right[p];
        }
    }
    cu = right[unknowns - 1] / a[unknowns - 1][unknowns - 1];
    cv = (right[unknowns - 2] - a[unknowns - 1][unknowns - 2] * cu) / a[unknowns - 2][unknowns - 2];
    return true;
}

template <int Degree>
bool Jet<Degree>::solve_by_reflections(std::size_t count, double& cu, double& cv) {
    problem_.clear();
    for (std::size_t j = 0; j < count; ++j) {
        auto& row = problem_.add();
        for (int c = 0; c <= unknowns; ++c) row[c] = columns_[static_cast<std::size_t>(c) * stride_ + j];
    }
    std::array<double, unknowns> c;
    if (!problem_.solve(c, rank_tolerance)) return false;
    cu = c[0], cv = c[1];
    return true;
}

template <int Degree>
bool Jet<Degree>::fit(const Neighborhood& neighborhood, const Frame& frame, Vec3& normal) {
    if (neighborhood.count < unknowns) return false;
    fill(neighborhood, frame);
    double cu, cv;
    if (!solve_normal_equations(stride_, cu, cv) && !solve_by_reflections(neighborhood.count, cu, cv)) return false;
    normal = unit(frame.n - cu * frame.u - cv * frame.v);
    return finite(normal);
}

/// The highest degree up to the one asked for that the neighbours determine; 0 where none.
int NormalFit::fit_jet(const Neighborhood& neighborhood, const Frame& frame, Vec3& normal) {
    if (degree_ >= 4 && std::get<3>(jets_).fit(neighborhood, frame, normal)) return 4;
    if (degree_ >= 3 && std::get<2>(jets_).fit(neighborhood, frame, normal)) return 3;
    if (degree_ >= 2 && std::get<1>(jets_).fit(neighborhood, frame, normal)) return 2;
    return std::get<0>(jets_).fit(neighborhood, frame, normal) ? 1 : 0;
}

NormalFit::Result NormalFit::operator()(const Neighborhood& neighborhood) {
    Result result = {principal_normal(neighborhood, method_ == CloudNormals::weighted_pca)};
    if (method_ != CloudNormals::jet || !finite(result.normal)) return result;
    const Frame frame = frame_about(result.normal);
    result.lowered = fit_jet(neighborhood, frame, result.normal) < degree_;
    result.normal = upward(result.normal);
    return result;
}

}  // namespace gaussmap
