// The sums of lane_spheres.h for one instruction set. Included by lane_spheres_<set>.cpp alone, each compiled for its
// set; nothing here may have external linkage but the entry that each defines, or the linker could pick a copy that the
// machine cannot run.
#pragma once

#include "lane_spheres.h"
#include "lane_vectors.h"

namespace gaussmap {
namespace {

/// Some lanes of the balls.
struct Balls {
    Vector u, v, n, foot;
    Real unit, least_square, least_cosine;

    GAUSSMAP_INLINE Balls(const LaneBalls& from, int lane)
        : u(load(from.axis[0], lane)),
          v(load(from.axis[1], lane)),
          n(load(from.axis[2], lane)),
          foot(load(from.foot, lane)),
          unit(1 / load(&from.radius[lane])),
          least_square(all(from.least_expected * from.least_expected)),
          least_cosine(all(from.least_cosine)) {}
};

/// What a sample's place and normal come to in the sums.
struct Term {
    Real of[SphereSums::terms], part[SphereSums::parts];
};

GAUSSMAP_INLINE Term see(const SphereSample* const (&samples)[lanes], const Balls& ball) {
    const Vector its_normal = gather_vector(samples, &SphereSample::normal),
                 d = ball.unit * (gather_vector(samples, &SphereSample::foot) - ball.foot);
    const Real far = dot(d, d), over = dot(d, ball.n);
    // The normal of the place, reflected by the plane half way to the sample, is the sample's on any circle through
    // both.
    const Real expected = dot(its_normal, ball.n) - 2 * over * dot(its_normal, d) / (far + near_by);
    const Vector normal = select(expected < 0, all(-1), all(1)) * its_normal;
    const Real cosine = dot(normal, ball.n);
    // What is not there is NaN, and would stay so with any weight.
    const Mask seen = (expected * expected >= ball.least_square) & (cosine >= ball.least_cosine) & (far < 1);
    const auto where_seen = [&](Real value) { return select(seen, value, Real{}); };
    const Real u = where_seen(dot(d, ball.u)), v = where_seen(dot(d, ball.v)), n = where_seen(over);
    const Real normal_u = where_seen(dot(normal, ball.u)), normal_v = where_seen(dot(normal, ball.v)),
               normal_n = where_seen(cosine);
    const Real k = where_seen(gather(samples, [](const SphereSample& s) { return s.weight; }));
    const Real pp = u * u + v * v + n * n, pn = u * normal_u + v * normal_v + n * normal_n;
    const Real s = 1 - pp, x = k * u, y = k * v, ks = k * s;
    return {{all(1), u, v, n, normal_u, normal_v, normal_n, pp, pn},
            {ks * s, ks * u, ks * v, ks * n, ks, x * u, x * v, x * n, y * v, y * n, k * n * n}};
}

/// Two samples at a time, so that the sums are loaded and stored once for both.
GAUSSMAP_INLINE void add(const Term& a, const Term& b, Real (&sums)[SphereSums::terms][SphereSums::parts]) {
    for (int t = 0; t < SphereSums::terms; ++t)
#pragma GCC unroll 11
        for (int i = 0; i < SphereSums::parts; ++i) sums[t][i] += a.of[t] * a.part[i] + b.of[t] * b.part[i];
}

void sum_up(const SphereSample* samples, const LaneBalls& balls, LaneSpheres& spheres) {
    static const SphereSample nothing;
    for (int lane = 0; lane < fit_lanes; lane += lanes) {
        const Balls ball(balls, lane);
        const auto term = [&](int s) {
            const SphereSample* at[lanes];
            pick(samples, nothing, balls, lane, s, at);
            return see(at, ball);
        };
        Real sums[SphereSums::terms][SphereSums::parts] = {};
        for (int s = 0; s < balls.count; s += 2) add(term(s), term(s + 1), sums);
        for (int t = 0; t < SphereSums::terms; ++t)
            for (int i = 0; i < SphereSums::parts; ++i) store(&spheres.sum[t][i][lane], sums[t][i]);
    }
}

}  // namespace
}  // namespace gaussmap
