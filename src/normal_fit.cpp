// Normals of cloud points: the smallest principal direction of the neighbours (principal_normal.h), and above it the
// normal of a polynomial height field fitted to them (Cazals and Pouget 2005).
#include "normal_fit.h"

#include <algorithm>
#include <array>

#include "principal_normal.h"

namespace gaussmap {
namespace {

/// A monomial that the others match this closely on the neighbours is not determined by them.
constexpr double rank_tolerance = 1e-4;
/// Above this the normal equations, whose condition is that of the fit squared, are as good as reflections.
constexpr double normal_equations_tolerance = 1e-2;

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

bool NormalFit::fit_alone(int degree, const Neighborhood& neighborhood, const Frame& frame, Vec3& normal) {
    switch (degree) {
        case 4:
            return std::get<3>(jets_).fit(neighborhood, frame, normal);
        case 3:
            return std::get<2>(jets_).fit(neighborhood, frame, normal);
        case 2:
            return std::get<1>(jets_).fit(neighborhood, frame, normal);
        default:
            return std::get<0>(jets_).fit(neighborhood, frame, normal);
    }
}

/// Smallest principal directions.
void NormalFit::find_principal(LaneNeighborhoods& around, Result (&results)[fit_lanes]) const {
    const bool weighted = method_ == CloudNormals::weighted_pca;
    LaneNormals normals = {};
    if (around.in_lanes()) best_cloud_kernel().principal(around.patches(), around.counts(), weighted, normals);
    for (std::size_t l = 0; l < around.count(); ++l)
        results[l] = {normals.found[l] ? Vec3{normals.n[0][l], normals.n[1][l], normals.n[2][l]}
                                       : principal_normal(around.alone(l), weighted)};
}

/// Fits over the frames of some lanes, where a kernel has the degree. The others may yet be determined: the condition
/// of normal equations is that of the fit squared.
void NormalFit::fit_in_lanes(int degree, LaneNeighborhoods& around, const Group& group) {
    std::fill_n(fields_.determined, fit_lanes, false);
    if (!around.in_lanes() || (degree != 2 && degree != 4)) return;
    const LaneFit& fit = degree == 2 ? best_lane_fit().quadric : best_lane_fit().quartic;
    LaneRange range = {{}, {}, Chart::monge, Weights::equal};
    for (std::size_t l = 0; l < around.count(); ++l) {
        if (!group.wanted[l] || around.counts()[l] < monomials(degree) - 1) continue;
        range.last[l] = around.counts()[l];
        around.patches().see(static_cast<int>(l), group.frame[l], 1);
    }
    fit.collect(around.patches().d, around.patches(), range, true, sums_);
    fit.solve(sums_, AtElement::zero, false, fields_);
}

void NormalFit::operator()(LaneNeighborhoods& around, Result (&results)[fit_lanes]) {
    find_principal(around, results);
    if (method_ != CloudNormals::jet) return;
    Group group = {};
    std::size_t wanted = 0;
    for (std::size_t l = 0; l < around.count(); ++l) {
        if (!finite(results[l].normal)) continue;
        group.frame[l] = frame_about(results[l].normal);
        group.wanted[l] = results[l].lowered = true;
        ++wanted;
    }
    // The highest degree up to the one asked for that the neighbours determine.
    for (int degree = degree_; degree > 0 && wanted > 0; --degree) {
        fit_in_lanes(degree, around, group);
        for (std::size_t l = 0; l < around.count(); ++l) {
            if (!group.wanted[l]) continue;
            const Frame& frame = group.frame[l];
            Vec3 normal = unit(frame.n - fields_.c[1][l] * frame.u - fields_.c[2][l] * frame.v);
            if (!(fields_.determined[l] && finite(normal)) && !fit_alone(degree, around.alone(l), frame, normal))
                continue;
            results[l] = {upward(normal), degree < degree_};
            group.wanted[l] = false;
            --wanted;
        }
    }
}

}  // namespace gaussmap
