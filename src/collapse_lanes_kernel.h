// Arithmetic of edge collapses, W edges or faces at a time, for one instruction set (triangle_lanes.h). Included by
// collapse_lanes_<set>.cpp alone; nothing here has external linkage but the entry that each defines.
#pragma once

#include "collapse_lanes.h"
#include "triangle_lanes.h"

namespace gaussmap {
namespace {

#define GAUSSMAP_INLINED __attribute__((always_inline))

template <int W>
struct Matrices {
    typename Lanes<W>::Real xx, xy, xz, yy, yz, zz;
};

template <int W>
GAUSSMAP_INLINE Vectors<W> product(const Matrices<W>& a, const Vectors<W>& p) {
    return {a.xx * p.x + a.xy * p.y + a.xz * p.z, a.xy * p.x + a.yy * p.y + a.yz * p.z,
            a.xz * p.x + a.yz * p.y + a.zz * p.z};
}
template <int W>
GAUSSMAP_INLINE Vectors<W> plus(const Vectors<W>& a, const Vectors<W>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int W>
GAUSSMAP_INLINE Vectors<W> all(Vec3 a) {
    const typename Lanes<W>::Real zero{};
    return {zero + a.x, zero + a.y, zero + a.z};
}

// Numbers 2 k and 2 k + 1 of W records of N, transposed in registers.
template <int W, int N>
GAUSSMAP_INLINE void pairs(const double* records, const std::int32_t* index, int k, typename Lanes<W>::Real& even,
                           typename Lanes<W>::Real& odd) {
    const double* p[W];
    for (int l = 0; l < W; ++l) p[l] = records + N * static_cast<std::size_t>(index[l]) + 2 * k;
    const auto low = join<W>(p, 0), high = join<W>(p + 1, 0);
    even = evens<W>(low, high), odd = odds<W>(low, high);
}

template <int W>
GAUSSMAP_INLINE typename Lanes<W>::Real costs_of(const VertexQuadrics& quadrics, std::int32_t v,
                                                 const std::int32_t* w) {
    using Real = typename Lanes<W>::Real;
    const Real zero{};
    const auto at = gather<W, 1>(&quadrics.position->x, w);
    const Vec3& from = quadrics.position[v];
    const Vectors<W> half{0.5 * (at.x - from.x), 0.5 * (at.y - from.y), 0.5 * (at.z - from.z)};
    const Symmetric& s = quadrics.shape[v];
    const Matrices<W> of_v{zero + s.xx, zero + s.xy, zero + s.xz, zero + s.yy, zero + s.yz, zero + s.zz};
    Matrices<W> of_w;
    pairs<W, 6>(&quadrics.shape->xx, w, 0, of_w.xx, of_w.xy);
    pairs<W, 6>(&quadrics.shape->xx, w, 1, of_w.xz, of_w.yy);
    pairs<W, 6>(&quadrics.shape->xx, w, 2, of_w.yz, of_w.zz);
    const Vectors<W> pull_v = product<W>(of_v, half), pull_w = product<W>(of_w, half);
    Vectors<W> g = minus<W>(pull_w, pull_v);
    Real c = dot<W>(half, plus<W>(pull_v, pull_w));
    if (quadrics.rest) {
        const QuadricRest& rest = quadrics.rest[v];
        Vectors<W> b;
        Real constant;
        pairs<W, 4>(&quadrics.rest->b.x, w, 0, b.x, b.y);
        pairs<W, 4>(&quadrics.rest->b.x, w, 1, b.z, constant);
        const Vectors<W> own = all<W>(rest.b);
        g = plus<W>(plus<W>(g, own), b);
        c += (rest.c + constant) - 2 * dot<W>(minus<W>(own, b), half);
    }
    const Matrices<W> sum{of_v.xx + of_w.xx, of_v.xy + of_w.xy, of_v.xz + of_w.xz,
                          of_v.yy + of_w.yy, of_v.yz + of_w.yz, of_v.zz + of_w.zz};
    const Real trace = sum.xx + sum.yy + sum.zz, held = collapse_pull * trace;
    const Real flat = 4 * flat_cost * trace * dot<W>(half, half);
    // As HeldInverse has it.
    const Real xx = sum.xx + held, yy = sum.yy + held, zz = sum.zz + held;
    const Matrices<W> minors{yy * zz - sum.yz * sum.yz, sum.xz * sum.yz - sum.xy * zz, sum.xy * sum.yz - sum.xz * yy,
                             xx * zz - sum.xz * sum.xz, sum.xy * sum.xz - xx * sum.yz, xx * yy - sum.xy * sum.xy};
    const Real scale = 1 / (xx * minors.xx + sum.xy * minors.xy + sum.xz * minors.xz);
    const Real least = c - scale * dot<W>(g, product<W>(minors, g));
    const Real above = least > zero ? least : zero;
    return flat + (held > zero ? above : zero);
}

// area n nᵀ of the parallelograms' halves; 0 where there is no area.
template <int W>
GAUSSMAP_INLINE Matrices<W> planes_of(const Vectors<W>& a, const Vectors<W>& b, const Vectors<W>& c) {
    using Real = typename Lanes<W>::Real;
    const Real zero{};
    const auto n = cross<W>(minus<W>(b, a), minus<W>(c, a));
    const Real twice_area = square_root<W>(dot<W>(n, n));
    const Real weight = twice_area > zero ? 0.5 / twice_area : zero;
    const Vectors<W> m{weight * n.x, weight * n.y, weight * n.z};
    return {m.x * n.x, m.x * n.y, m.x * n.z, m.y * n.y, m.y * n.z, m.z * n.z};
}

// Triples of an array in groups of W, the last made up with copies of the last one.
template <int W, class Body>
GAUSSMAP_INLINE void for_groups(const std::int32_t* triples, std::size_t count, Body&& body) {
    for (std::size_t i = 0; i < count; i += W) {
        const std::int32_t* group = triples + 3 * i;
        std::int32_t last[3 * W];
        const int valid = static_cast<int>(count - i < W ? count - i : W);
        if (valid < W) {
            for (int k = 0; k < 3 * W; ++k) last[k] = triples[3 * (k / 3 < valid ? i + k / 3 : count - 1) + k % 3];
            group = last;
        }
        body(group, i, valid);
    }
}

template <int W>
struct CollapseKernel {
    using Real = typename Lanes<W>::Real;

    static void costs(const VertexQuadrics& quadrics, std::int32_t v, const std::int32_t* w, std::size_t count,
                      double* cost) {
        for (std::size_t i = 0; i < count; i += W) {
            const int valid = static_cast<int>(count - i < W ? count - i : W);
            std::int32_t indices[W];
            for (int l = 0; l < W; ++l) indices[l] = w[l < valid ? i + l : count - 1];
            const Real at = costs_of<W>(quadrics, v, indices);
            for (int l = 0; l < valid; ++l) cost[i + l] = at[l];
        }
    }

    static bool may_spoil(const Vec3* position, const RingMesh::Sector* sectors, std::size_t count, Vec3 at, Vec3 p) {
        const Real zero{};
        const Vectors<W> before = all<W>(at), after = all<W>(p);
        auto any = zero > zero;
        for_groups<W>(&sectors->corner, count, [&](const std::int32_t* indices, std::size_t, int) GAUSSMAP_INLINED {
            const auto from = gather<W>(&position->x, indices + 1), to = gather<W>(&position->x, indices + 2);
            const auto n = cross<W>(minus<W>(from, before), minus<W>(to, before));
            const auto e = minus<W>(from, after), f = minus<W>(to, after), g = minus<W>(f, e);
            const auto m = cross<W>(e, f);
            const Real nn = dot<W>(n, n), mm = dot<W>(m, m), cosine = dot<W>(n, m);
            const Real squares = dot<W>(e, e) + dot<W>(f, f) + dot<W>(g, g);
            // Asked the other way round, so that what is no number is suspect.
            const auto stays = (mm > sliver * sliver * squares * squares) & (cosine > zero) &
                               (cosine * cosine >= least_cosine * least_cosine * nn * mm);
            any |= ~stays;
        });
        for (int l = 0; l < W; ++l)
            if (any[l]) return true;
        return false;
    }

    static void face_planes(const Vec3* position, const std::int32_t* corners, std::size_t count, double* planes) {
        for_groups<W>(corners, count, [&](const std::int32_t* indices, std::size_t i, int valid) GAUSSMAP_INLINED {
            const auto a = planes_of<W>(gather<W>(&position->x, indices), gather<W>(&position->x, indices + 1),
                                        gather<W>(&position->x, indices + 2));
            for (int l = 0; l < valid; ++l)
                for (int k = 0; k < 3; ++k) {
                    double* out = planes + 18 * (i + l) + 6 * k;
                    out[0] = a.xx[l], out[1] = a.xy[l], out[2] = a.xz[l];
                    out[3] = a.yy[l], out[4] = a.yz[l], out[5] = a.zz[l];
                }
        });
    }

    static Symmetric planes(const Vec3* position, const RingMesh::Sector* sectors, std::size_t count, Vec3 at) {
        const Vectors<W> centre = all<W>(at);
        Symmetric sum;
        for_groups<W>(
            &sectors->corner, count, [&](const std::int32_t* indices, std::size_t, int valid) GAUSSMAP_INLINED {
                const auto a =
                    planes_of<W>(centre, gather<W>(&position->x, indices + 1), gather<W>(&position->x, indices + 2));
                // One after the other: the same bits for every W.
                for (int l = 0; l < valid; ++l) {
                    sum.xx += a.xx[l], sum.xy += a.xy[l], sum.xz += a.xz[l];
                    sum.yy += a.yy[l], sum.yz += a.yz[l], sum.zz += a.zz[l];
                }
            });
        return sum;
    }
};

}  // namespace
}  // namespace gaussmap
