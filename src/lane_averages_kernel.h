// The averages of lane_averages.h for one instruction set. Included by lane_averages_<set>.cpp alone, each compiled for
// its set; nothing here may have external linkage but the entry that each defines, or the linker could pick a copy that
// the machine cannot run.
#pragma once

#include "lane_averages.h"
#include "lane_vectors.h"

namespace gaussmap {
namespace {

/// Some lanes of the centres.
struct Centres {
    Vector u, v, n, foot;
    Real unit, inverse_reach[2], reach;

    GAUSSMAP_INLINE Centres(const LaneCentres& from, int lane)
        : u(load(from.axis[0], lane)),
          v(load(from.axis[1], lane)),
          n(load(from.axis[2], lane)),
          foot(load(from.foot, lane)),
          unit(load(&from.unit[lane])),
          reach(load(&from.reach[1][lane])) {
        for (int m = 0; m < 2; ++m) inverse_reach[m] = 1 / load(&from.reach[m][lane]);
    }
};

/// A sample as it is seen from the centre.
struct Sight {
    Real u, v;  ///< its place in the frame
    Real normal_u, normal_v;
    Real uu, uv, vv;  ///< its shape operator, turned
    Real weight[2];
};

GAUSSMAP_INLINE Sight see(const SurfaceSample* const (&samples)[lanes], const Centres& centre) {
    const Vector its_normal = gather_vector(samples, &SurfaceSample::normal),
                 d = gather_vector(samples, &SurfaceSample::foot) - centre.foot;
    const Real along = dot(its_normal, centre.n), away = dot(d, d);
    const Real sign = select(along < 0, all(-1), all(1)), cosine = sign * along;
    const Vector normal = sign * its_normal;
    Sight sight;
    sight.u = centre.unit * dot(d, centre.u), sight.v = centre.unit * dot(d, centre.v);
    sight.normal_u = dot(normal, centre.u), sight.normal_v = dot(normal, centre.v);
    // Tangents turned to the sample's plane: t goes to t − w (w·t) / (1 + cosine), w the sum of the normals.
    const Vector w = normal + centre.n;
    const Real c = 1 / (1 + cosine);
    const Vector a = centre.u - (sight.normal_u * c) * w, b = centre.v - (sight.normal_v * c) * w;
    Real t[6];
    for (int i = 0; i < 6; ++i) t[i] = gather(samples, [&](const SurfaceSample& s) { return s.tensor[i]; });
    const auto product = [&](Vector x) {
        return Vector{t[0] * x.x + t[1] * x.y + t[2] * x.z, t[1] * x.x + t[3] * x.y + t[4] * x.z,
                      t[2] * x.x + t[4] * x.y + t[5] * x.z};
    };
    const Vector ta = product(a), tb = product(b);
    sight.uu = sign * dot(a, ta), sight.uv = sign * dot(b, ta), sight.vv = sign * dot(b, tb);
    // Other sheets and far sides look elsewhere.
    const Mask seen = (cosine >= one_sheet) & (away < centre.reach);
    const Real known = select(seen, gather(samples, [](const SurfaceSample& s) { return s.weight; }), Real{});
    for (int m = 0; m < 2; ++m) {
        const Real weight = 1 - away * centre.inverse_reach[m];
        sight.weight[m] = select(seen & (weight > 0), known * weight, Real{});
    }
    // What is not there is NaN, and would stay so with any weight.
    for (Real* value : {&sight.u, &sight.v, &sight.normal_u, &sight.normal_v, &sight.uu, &sight.uv, &sight.vv})
        *value = select(seen, *value, Real{});
    return sight;
}

/// Sums of one window.
struct Sums {
    Real weight, count, tensor[3], power[SlopeFit::powers], slope[SlopeFit::most][2], normal[2], square;
};

/// Two samples at a time, so that the sums are loaded and stored once for both.
template <int M>
GAUSSMAP_INLINE void add(const Sight& a, const Sight& b, Sums& sums) {
    const Real wa = a.weight[M], wb = b.weight[M];
    sums.weight += wa + wb;
    sums.count += select(wa > 0, all(1), Real{}) + select(wb > 0, all(1), Real{});
    sums.normal[0] += wa * a.normal_u + wb * b.normal_u;
    sums.normal[1] += wa * a.normal_v + wb * b.normal_v;
    sums.tensor[0] += wa * a.uu + wb * b.uu;
    sums.tensor[1] += wa * a.uv + wb * b.uv;
    sums.tensor[2] += wa * a.vv + wb * b.vv;
    sums.square += wa * (a.normal_u * a.normal_u + a.normal_v * a.normal_v) +
                   wb * (b.normal_u * b.normal_u + b.normal_v * b.normal_v);
    Real at_a[5] = {wa}, at_b[5] = {wb};  // weighted monomials of one degree
    int at = 0;
#pragma GCC unroll 4
    for (int degree = 1; degree <= 4; ++degree) {
        at_a[degree] = a.v * at_a[degree - 1], at_b[degree] = b.v * at_b[degree - 1];
#pragma GCC unroll 4
        for (int i = 0; i < degree; ++i) at_a[i] = a.u * at_a[i], at_b[i] = b.u * at_b[i];
#pragma GCC unroll 5
        for (int i = 0; i <= degree; ++i, ++at) {
            sums.power[at] += at_a[i] + at_b[i];
            if (degree > 2) continue;
            Real(&slope)[2] = sums.slope[degree == 2 ? i : 3 + i];
            slope[0] += at_a[i] * a.normal_u + at_b[i] * b.normal_u;
            slope[1] += at_a[i] * a.normal_v + at_b[i] * b.normal_v;
        }
    }
}

void keep(const Sums& sums, int lane, LaneAverages& to) {
    store(&to.weight[lane], sums.weight);
    store(&to.count[lane], sums.count);
    for (int i = 0; i < 3; ++i) store(&to.tensor[i][lane], sums.tensor[i]);
    for (int i = 0; i < SlopeFit::powers; ++i) store(&to.power[i][lane], sums.power[i]);
    for (int i = 0; i < SlopeFit::most; ++i)
        for (int c = 0; c < 2; ++c) store(&to.slope[i][c][lane], sums.slope[i][c]);
    for (int c = 0; c < 2; ++c) store(&to.normal[c][lane], sums.normal[c]);
    store(&to.square[lane], sums.square);
}

void average(const SurfaceSample* samples, const LaneCentres& centres, LaneAverages (&windows)[2]) {
    static const SurfaceSample nothing;
    for (int lane = 0; lane < fit_lanes; lane += lanes) {
        const Centres centre(centres, lane);
        const auto sight = [&](int s) {
            const SurfaceSample* at[lanes];
            pick(samples, nothing, centres, lane, s, at);
            return see(at, centre);
        };
        Sums narrow = {}, wide = {};
        for (int s = 0; s < centres.count; s += 2) {
            const Sight a = sight(s), b = sight(s + 1);
            add<1>(a, b, wide);
            if (bits_of((a.weight[0] > 0) | (b.weight[0] > 0)) != 0) add<0>(a, b, narrow);
        }
        keep(narrow, lane, windows[0]);
        keep(wide, lane, windows[1]);
    }
}

}  // namespace
}  // namespace gaussmap
