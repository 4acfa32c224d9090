// The fused pass over triangles, W at a time, for one instruction set (triangle_lanes.h). Included by
// vertex_density_<set>.cpp alone; nothing here has external linkage but the entry that each defines.
//
// Per triangle abc with unit normals n (docs/method.md, eq. (3)):
//   2A = |(b − a) × (c − a)|,   S = Σ_i d_i |n_j − n_k|²,   d_i the dot product of the two edges leaving corner i,
//   kappa = S / (2 · 2A),   area = 2A / 2.
// The sums hold S / 2A and 2A, twice each, which leaves their quotient, the density, as it is.
#pragma once

#include "degenerate.h"
#include "triangle_lanes.h"
#include "vertex_density.h"

namespace gaussmap {
namespace {

template <int W>
struct Energies {
    typename Lanes<W>::Real kappa, area;         // S / 2A and 2A, both 0 where the triangle adds nothing
    typename Lanes<W>::Mask usable, degenerate;  // all ones where so
};

template <int W>
GAUSSMAP_INLINE Energies<W> energies(const double* xyz, const double* normals, const std::int32_t* abc) {
    using Real = typename Lanes<W>::Real;
    const auto a = gather<W>(xyz, abc), b = gather<W>(xyz, abc + 1), c = gather<W>(xyz, abc + 2);
    asm volatile("" ::: "memory");  // load the indices again rather than spill 3 W of them
    const auto na = gather<W>(normals, abc), nb = gather<W>(normals, abc + 1), nc = gather<W>(normals, abc + 2);
    const auto ab = minus<W>(b, a), ac = minus<W>(c, a), bc = minus<W>(c, b);
    const Real da = dot<W>(ab, ac), db = -dot<W>(ab, bc), dc = dot<W>(ac, bc);
    const auto nab = minus<W>(nb, na), nac = minus<W>(nc, na), nbc = minus<W>(nc, nb);
    const Real s = da * dot<W>(nbc, nbc) + db * dot<W>(nac, nac) + dc * dot<W>(nab, nab);
    const auto normal = cross<W>(ab, ac);
    const Real cross_squared = dot<W>(normal, normal);
    const Real half_squares = da + db + dc;
    const Real threshold = no_area_ratio * (half_squares * half_squares);
    const Real huge = Real{} + __DBL_MAX__, zero = Real{};

    Energies<W> e;
    e.degenerate = (cross_squared <= threshold) & (threshold <= huge);
    e.usable = (cross_squared > threshold) & (cross_squared <= huge) & (s <= huge) & (s >= -huge);
    const Real area = square_root<W>(cross_squared);
    // The energy is never negative; rounding could make it so by its last bit.
    const Real kappa = (s > zero ? s : zero) / area;
    e.kappa = e.usable ? kappa : zero;
    e.area = e.usable ? area : zero;
    return e;
}

// Add the pairs of `valid` triangles to their corners; corners that an earlier chunk owns are set aside.
template <int W, bool Alone>
GAUSSMAP_INLINE void add_corners(FusedPass& pass, const std::int32_t* abc, const double* pairs, int valid) {
    for (int l = 0; l < valid; ++l) {
        const Pair pair = *reinterpret_cast<const Pair*>(pairs + (l & 1) * W + (l & ~1));
        for (int corner = 0; corner < 3; ++corner) {
            const std::int32_t vertex = abc[3 * l + corner];
            if (Alone || pass.owner[vertex] == pass.chunk) {
                *reinterpret_cast<PairInMemory*>(pass.sums + 2 * static_cast<std::size_t>(vertex)) += pair;
            } else {
                *pass.aside++ = {vertex, pair[0], pair[1]};
            }
        }
    }
}

template <int W>
GAUSSMAP_INLINE void write_faces(const FusedPass& pass, std::size_t face, const Energies<W>& e, int valid) {
    using Real = typename Lanes<W>::Real;
    const Real undefined = Real{} + __builtin_nan("");
    const Real kappa = e.usable ? 0.5 * e.kappa : (e.degenerate ? Real{} : undefined);
    const Real density = e.usable ? e.kappa / e.area : undefined;
    for (int l = 0; l < valid; ++l) pass.face_kappa[face + l] = kappa[l], pass.face_density[face + l] = density[l];
}

// The energies of W triangles as pairs (even ones, then odd ones), and to the faces where they are wanted.
template <int W>
GAUSSMAP_INLINE void compute(const FusedPass& pass, std::size_t face, const std::int32_t* abc, int valid,
                             double* pairs) {
    const Energies<W> e = energies<W>(pass.xyz, pass.normals, abc);
    *reinterpret_cast<typename Lanes<W>::Real*>(pairs) = evens<W>(e.kappa, e.area);
    *reinterpret_cast<typename Lanes<W>::Real*>(pairs + W) = odds<W>(e.kappa, e.area);
    if (pass.face_kappa) write_faces<W>(pass, face, e, valid);
}

template <int W, bool Alone>
inline SetAside* run(const FusedPass& given, std::size_t begin, std::size_t end) {
    FusedPass pass = given;  // a copy that no store can alias stays in registers
    alignas(64) double pairs[2][2 * W];
    std::size_t face = begin;
    int turn = 0;
    // A batch is added one turn late: additions to one vertex wait for each other, and the arithmetic of the next batch
    // fills that time.
    for (; face + W <= end; face += W, turn ^= 1) {
        compute<W>(pass, face, pass.abc + 3 * face, W, pairs[turn]);
        if (face > begin) add_corners<W, Alone>(pass, pass.abc + 3 * (face - W), pairs[turn ^ 1], W);
    }
    if (face > begin) add_corners<W, Alone>(pass, pass.abc + 3 * (face - W), pairs[turn ^ 1], W);
    if (face == end) return pass.aside;
    // The last few, made up to W with copies of the last one, which are not added.
    std::int32_t abc[3 * W];
    for (int l = 0; l < W; ++l)
        for (int corner = 0; corner < 3; ++corner)
            abc[3 * l + corner] = pass.abc[3 * (face + l < end ? face + l : end - 1) + corner];
    const int valid = static_cast<int>(end - face);
    compute<W>(pass, face, abc, valid, pairs[turn]);
    add_corners<W, Alone>(pass, abc, pairs[turn], valid);
    return pass.aside;
}

template <int W>
inline void run(FusedPass& pass, std::size_t begin, std::size_t end) {
    pass.aside = pass.owner ? run<W, false>(pass, begin, end) : run<W, true>(pass, begin, end);
}

inline std::uint32_t highest(const std::int32_t* indices, std::size_t count) {
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(indices[i]);
        result = index > result ? index : result;
    }
    return result;
}

// S / 2A over 2A where there is any, and 2A / 2.
inline void divide(double* sums, std::size_t count) {
    const Pair undefined = {__builtin_nan(""), __builtin_nan("")};
    auto* pairs = reinterpret_cast<PairInMemory*>(sums);
    std::size_t v = 0;
    for (; v + 2 <= count; v += 2) {
        const Pair one = pairs[v], two = pairs[v + 1];
        const Pair energy = __builtin_shufflevector(one, two, 0, 2), area = __builtin_shufflevector(one, two, 1, 3);
        const Pair quotient = energy / area;
        const Pair density = area > Pair{} ? quotient : undefined, half = 0.5 * area;
        pairs[v] = __builtin_shufflevector(density, half, 0, 2);
        pairs[v + 1] = __builtin_shufflevector(density, half, 1, 3);
    }
    if (v == count) return;
    const double quotient = sums[2 * v] / sums[2 * v + 1];
    sums[2 * v] = sums[2 * v + 1] > 0 ? quotient : undefined[0];
    sums[2 * v + 1] *= 0.5;
}

}  // namespace
}  // namespace gaussmap
