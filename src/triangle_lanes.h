// W triangles at a time for one instruction set: their corners gathered into registers, and arithmetic on them.
// Included by kernels alone (*_kernel.h), each compiled for its set; nothing here may have external linkage, or the
// linker could pick a copy that the machine cannot run. Every set rounds every operation alike, so all give the same
// bits.
#pragma once

#include <cstddef>
#include <cstdint>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace gaussmap {
namespace {

#define GAUSSMAP_INLINE inline __attribute__((always_inline))

// W doubles, and W/2 pairs of doubles as they lie in memory.
template <int W>
struct Lanes {
    typedef double Real __attribute__((vector_size(8 * W)));
    typedef long long Mask __attribute__((vector_size(8 * W)));
};
typedef double Pair __attribute__((vector_size(16)));
typedef double PairInMemory __attribute__((vector_size(16), aligned(8), may_alias));

GAUSSMAP_INLINE Pair load_pair(const double* p) {
    return *reinterpret_cast<const PairInMemory*>(p);
}

GAUSSMAP_INLINE void store_pair(double* p, Pair a) {
    *reinterpret_cast<PairInMemory*>(p) = a;
}

// The pairs at p[0] and p[2] side by side; for two lanes the one at p[0].
template <int W>
GAUSSMAP_INLINE typename Lanes<W>::Real join(const double* const* p, int offset) {
    if constexpr (W == 2)
        return load_pair(p[0] + offset);
    else
        return __builtin_shufflevector(load_pair(p[0] + offset), load_pair(p[2] + offset), 0, 1, 2, 3);
}

// Even (odd) entries of a and b in turn: a0 b0 a2 b2 … (a1 b1 a3 b3 …).
template <int W, class Real>
GAUSSMAP_INLINE Real evens(Real a, Real b) {
    if constexpr (W == 2)
        return __builtin_shufflevector(a, b, 0, 2);
    else
        return __builtin_shufflevector(a, b, 0, 4, 2, 6);
}
template <int W, class Real>
GAUSSMAP_INLINE Real odds(Real a, Real b) {
    if constexpr (W == 2)
        return __builtin_shufflevector(a, b, 1, 3);
    else
        return __builtin_shufflevector(a, b, 1, 5, 3, 7);
}

// Entries 2 i and 2 i + 1.
template <int W, class Real>
GAUSSMAP_INLINE Pair pair(Real a, int i) {
    if constexpr (W == 2)
        return a;
    else
        return i == 0 ? __builtin_shufflevector(a, a, 0, 1) : __builtin_shufflevector(a, a, 2, 3);
}

template <int W>
struct Vectors {
    typename Lanes<W>::Real x, y, z;
};

// The three coordinates of W vertices, transposed in registers. Reads 24 bytes a vertex, nothing beyond.
template <int W, int Stride = 3>
GAUSSMAP_INLINE Vectors<W> gather(const double* xyz, const std::int32_t* index) {
    const double* p[W];
    for (int l = 0; l < W; ++l) p[l] = xyz + 3 * static_cast<std::size_t>(index[Stride * l]);
    const auto xy_even = join<W>(p, 0), xy_odd = join<W>(p + 1, 0);
    const auto yz_even = join<W>(p, 1), yz_odd = join<W>(p + 1, 1);
    return {evens<W>(xy_even, xy_odd), odds<W>(xy_even, xy_odd), odds<W>(yz_even, yz_odd)};
}

template <int W>
GAUSSMAP_INLINE Vectors<W> minus(const Vectors<W>& a, const Vectors<W>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int W>
GAUSSMAP_INLINE typename Lanes<W>::Real dot(const Vectors<W>& a, const Vectors<W>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <int W>
GAUSSMAP_INLINE Vectors<W> cross(const Vectors<W>& a, const Vectors<W>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Compilers do not make one instruction of a loop of square roots over lanes.
template <int W, class Real>
GAUSSMAP_INLINE Real square_root(Real a) {
#ifdef __AVX2__
    if constexpr (W == 4) return (Real)_mm256_sqrt_pd((__m256d)a);
#endif
#ifdef __SSE2__
    if constexpr (W == 2) return (Real)_mm_sqrt_pd((__m128d)a);
#endif
    Real root;
    for (int l = 0; l < W; ++l) root[l] = __builtin_sqrt(a[l]);
    return root;
}

}  // namespace
}  // namespace gaussmap
