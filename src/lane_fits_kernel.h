// The fits of lane_fits.h for one instruction set. Included by lane_fits_<set>.cpp alone, each compiled for its set;
// nothing here may have external linkage but the entry that each defines, or the linker could pick a copy that the
// machine cannot run.
#pragma once

#include "lane_fits.h"
#include "registers.h"

namespace gaussmap {
namespace {

/// A neighbour in its chart.
struct Datum {
    Real u, v, height, weight;
};

/// Some lanes of what is collected: which neighbours count, and where they are seen from.
struct Seen {
    Real first, last, axis[3][3], foot[3];

    GAUSSMAP_INLINE Seen(const LaneViews& views, const LaneRange& range, int lane) {
        for (int l = 0; l < lanes; ++l) first[l] = range.first[lane + l], last[l] = range.last[lane + l];
        for (int a = 0; a < 3; ++a) {
            foot[a] = load(&views.foot[a][lane]);
            for (int c = 0; c < 3; ++c) axis[a][c] = load(&views.axis[a][c][lane]);
        }
    }
};

/// Neighbour j of the lanes from `lane` on.
template <bool Chord, Weights Weighing>
GAUSSMAP_INLINE Datum datum(const LaneNeighbor* neighbors, const Seen& seen, int lane, int j) {
    const Real x = load(&neighbors[j][0][lane]) - seen.foot[0], y = load(&neighbors[j][1][lane]) - seen.foot[1],
               z = load(&neighbors[j][2][lane]) - seen.foot[2];
    const auto along = [&](int a) { return x * seen.axis[a][0] + y * seen.axis[a][1] + z * seen.axis[a][2]; };
    Datum datum = {along(0), along(1), along(2), all(1)};
    const Real flat = datum.u * datum.u + datum.v * datum.v, squared = flat + datum.height * datum.height;
    if (Chord) {
        // Where the surface stands upright the direction is lost: no farther out than four times the projection.
        const Real ratio = squared / flat;
        const Real stretch = square_root(select(ratio < 16, ratio, select(flat > 0, all(16), all(1))));
        datum.u *= stretch, datum.v *= stretch;
    }
    if (Weighing == Weights::remainder) {
        // Nearer than a fifth of the unit all weigh alike, so that a pair of almost equal points does not decide alone.
        const Real r = 1 / select(squared > 0.04, squared, all(0.04)), r2 = r * r;
        datum.weight = r2 * r2 * r;
    }
    if (Weighing == Weights::smoothing) datum.weight = 1 - minimum(squared, all(1)) * (1 / 1.1);
    const Real at = all(j);
    datum.weight = select((at >= seen.first) & (at < seen.last), datum.weight, Real{});
    return datum;
}

/// Sums of one group of lanes.
template <int Degree>
struct Sums {
    static constexpr int terms = monomials(Degree), powers = monomials(2 * Degree);
    Real power[powers], height[terms], square;
};

/// Two neighbours at a time, so that the sums are loaded and stored once for both.
template <int Degree>
GAUSSMAP_INLINE void add(const Datum& a, const Datum& b, Sums<Degree>& sums) {
    Real at_a[2 * Degree + 1], at_b[2 * Degree + 1];  // weighted monomials of one degree
    at_a[0] = a.weight, at_b[0] = b.weight;
    int at = 0;
#pragma GCC unroll 9
    for (int degree = 0; degree <= 2 * Degree; ++degree) {
        if (degree > 0) {
            at_a[degree] = a.v * at_a[degree - 1], at_b[degree] = b.v * at_b[degree - 1];
#pragma GCC unroll 9
            for (int i = 0; i < degree; ++i) at_a[i] = a.u * at_a[i], at_b[i] = b.u * at_b[i];
        }
#pragma GCC unroll 9
        for (int i = 0; i <= degree; ++i, ++at) {
            sums.power[at] += at_a[i] + at_b[i];
            if (degree <= Degree) sums.height[at] += a.height * at_a[i] + b.height * at_b[i];
        }
    }
    sums.square += a.weight * a.height * a.height + b.weight * b.height * b.height;
}

template <int Degree, bool Chord, Weights Weighing>
void collect(const LaneNeighbor* neighbors, const LaneViews& views, const LaneRange& range, bool fresh, LaneSums& to) {
    int first = range.first[0], last = range.last[0];
    for (int l = 1; l < fit_lanes; ++l) {
        first = range.first[l] < first ? range.first[l] : first;
        last = range.last[l] > last ? range.last[l] : last;
    }
    for (int lane = 0; lane < fit_lanes; lane += lanes) {
        const Seen seen(views, range, lane);
        Sums<Degree> sums = {};
        if (!fresh) {
            for (int s = 0; s < sums.powers; ++s) sums.power[s] = load(&to.at[to.power + s][lane]);
            for (int s = 0; s < sums.terms; ++s) sums.height[s] = load(&to.at[to.height + s][lane]);
            sums.square = load(&to.at[to.square][lane]);
        }
        for (int j = first; j < last; j += 2) {
            const int next = j + 1 < last ? j + 1 : j;
            const Datum a = datum<Chord, Weighing>(neighbors, seen, lane, j);
            Datum b = datum<Chord, Weighing>(neighbors, seen, lane, next);
            if (next == j) b.weight = Real{};
            add(a, b, sums);
        }
        for (int s = 0; s < sums.powers; ++s) store(&to.at[to.power + s][lane], sums.power[s]);
        for (int s = 0; s < sums.terms; ++s) store(&to.at[to.height + s][lane], sums.height[s]);
        store(&to.at[to.square][lane], sums.square);
    }
}

template <int Degree, bool Chord>
void collect_in_chart(const LaneNeighbor* neighbors, const LaneViews& views, const LaneRange& range, bool fresh,
                      LaneSums& sums) {
    switch (range.weights) {
        case Weights::equal:
            return collect<Degree, Chord, Weights::equal>(neighbors, views, range, fresh, sums);
        case Weights::remainder:
            return collect<Degree, Chord, Weights::remainder>(neighbors, views, range, fresh, sums);
        case Weights::smoothing:
            return collect<Degree, Chord, Weights::smoothing>(neighbors, views, range, fresh, sums);
    }
}

template <int Degree>
void collect_as_told(const LaneNeighbor* neighbors, const LaneViews& views, const LaneRange& range, bool fresh,
                     LaneSums& sums) {
    (range.chart == Chart::chord ? collect_in_chart<Degree, true>
                                 : collect_in_chart<Degree, false>)(neighbors, views, range, fresh, sums);
}

/// Where the normal equations are among the sums: row r of column c. The right side is one more row, and what fills up
/// to whole groups of four is of no use.
template <int Degree, bool Constant>
struct NormalEquations {
    static constexpr int skip = Constant ? 0 : 1, unknowns = monomials(Degree) - skip,
                         rows = (unknowns + 1 + 3) / 4 * 4;
    int sum[unknowns][rows] = {};
    constexpr NormalEquations() {
        int degree[unknowns] = {}, power_of_v[unknowns] = {};
        for (int d = skip, at = 0; d <= Degree; ++d)
            for (int j = 0; j <= d; ++j, ++at) degree[at] = d, power_of_v[at] = j;
        for (int c = 0; c < unknowns; ++c) {
            for (int r = 0; r < unknowns; ++r) {
                const int d = degree[r] + degree[c];
                sum[c][r] = LaneSums::power + d * (d + 1) / 2 + power_of_v[r] + power_of_v[c];
            }
            sum[c][unknowns] = LaneSums::height + c + skip;
        }
    }
};

/// L D Lᵀ of the normal equations, a column at a time, four rows of it at once.
template <int Degree, bool Constant>
struct Factors {
    static constexpr NormalEquations<Degree, Constant> equations = {};
    static constexpr int n = equations.unknowns, rows = equations.rows;
    Real low[n][rows], raw[n][rows];  ///< entries [c][r] of L and of L D, r ≥ c / 4 · 4
    Real inverse[n];                  ///< of D
    Mask determined = Mask{} - 1;

    /// \param element  weight of the elements, as data of height 0.
    GAUSSMAP_INLINE Factors(const LaneSums& sums, double element, int lane) {
        // Of the diagonal: a monomial that the others match to the root of this is not determined.
        constexpr double rank_tolerance = 1e-6;
        for (int c = 0; c < n; ++c) {
            const int* const from = equations.sum[c];
            for (int r = c / 4 * 4; r < rows; r += 4) {
                Real a[4];
                for (int i = 0; i < 4; ++i) a[i] = load(&sums.at[from[r + i]][lane]);
                // The element itself, where all monomials but the constant are 0.
                if (Constant && c == 0 && r == 0) a[0] += element;
                for (int k = 0; k < c; ++k)
                    for (int i = 0; i < 4; ++i) a[i] -= low[k][r + i] * raw[k][c];
                for (int i = 0; i < 4; ++i) raw[c][r + i] = a[i];
            }
            const Real pivot = raw[c][c], diagonal = load(&sums.at[from[c]][lane]) + (Constant && c == 0 ? element : 0);
            determined &= (pivot > rank_tolerance * diagonal) & (diagonal <= __DBL_MAX__);
            inverse[c] = 1 / pivot;
            for (int r = c / 4 * 4; r < rows; ++r) low[c][r] = r > c ? raw[c][r] * inverse[c] : Real{};
        }
    }
};

/// Of the second derivatives: products of columns of the inverse of L, from their diagonals on.
template <int Degree, bool Constant>
GAUSSMAP_INLINE void store_covariance(const Factors<Degree, Constant>& factors, int lane, LaneFields& fields) {
    constexpr int n = Factors<Degree, Constant>::n, begin = Constant ? 3 : 2;
    constexpr double factor[3] = {2, 1, 2};
    Real column[3][n];
    for (int q = 0; q < 3; ++q) {
        for (int i = begin; i < n; ++i) column[q][i] = all(i == begin + q ? 1 : 0);
        for (int k = begin + q; k < n; ++k)
            for (int i = k + 1; i < n; ++i) column[q][i] -= factors.low[k][i] * column[q][k];
    }
    for (int p = 0; p < 3; ++p)
        for (int q = 0; q <= p; ++q) {
            Real value = {};
            for (int i = begin + p; i < n; ++i) value += column[p][i] * column[q][i] * factors.inverse[i];
            value *= factor[p] * factor[q];
            store(&fields.covariance[p][q][lane], value);
            store(&fields.covariance[q][p][lane], value);
        }
}

template <int Degree, bool Constant>
void solve_lanes(const LaneSums& sums, double element, bool covariance, int lane, LaneFields& fields) {
    const Factors<Degree, Constant> factors(sums, element, lane);
    constexpr int n = Factors<Degree, Constant>::n, skip = Constant ? 0 : 1;
    Real residual = load(&sums.at[sums.square][lane]), x[n];
    for (int k = 0; k < n; ++k) {
        residual -= factors.raw[k][n] * factors.low[k][n];
        x[k] = factors.low[k][n];
    }
    store(&fields.residual[lane], select(residual > 0, residual, Real{}));
    for (int i = n - 1; i > 0; --i)
        for (int k = 0; k < i; ++k) x[k] -= factors.low[k][i] * x[i];
    if (!Constant) store(&fields.c[0][lane], Real{});
    for (int m = skip; m < monomials(2); ++m) store(&fields.c[m][lane], x[m - skip]);
    if (covariance) store_covariance(factors, lane, fields);
    for (int l = 0; l < lanes; ++l) fields.determined[lane + l] = factors.determined[l] != 0;
}

template <int Degree>
void solve(const LaneSums& sums, AtElement element, bool covariance, LaneFields& fields) {
    for (int lane = 0; lane < fit_lanes; lane += lanes) {
        if (element == AtElement::zero)
            solve_lanes<Degree, false>(sums, 0, covariance, lane, fields);
        else
            solve_lanes<Degree, true>(sums, element == AtElement::datum ? 1 : 0, covariance, lane, fields);
    }
}

constexpr LaneFitKernel kernel = {{collect_as_told<2>, solve<2>}, {collect_as_told<4>, solve<4>}};

}  // namespace
}  // namespace gaussmap
