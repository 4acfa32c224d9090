// Sorting doubles in vector registers: blocks of 32 by a network, then merging, sixteen at a time. Part of the kernels
// that include it, one for each instruction set; without external linkage for their reason. Keys that differ come out
// in the one order there is, whatever the instruction set.
//
// The 8-input network has 19 comparisons (Knuth, The Art of Computer Programming 3, 5.3.4); merging is bitonic
// (Batcher, "Sorting Networks and Their Applications", 1968).
#pragma once

#include <cstddef>
#include <limits>

#include "registers.h"

namespace gaussmap {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

GAUSSMAP_INLINE double lesser(double a, double b) {
    return a < b ? a : b;
}
GAUSSMAP_INLINE double greater(double a, double b) {
    return a > b ? a : b;
}

/// Four doubles, and what their halves can be made into.
#ifdef __AVX2__
struct Quad {
    __m256d v;
};
GAUSSMAP_INLINE Quad load_quad(const double* p) {
    return {_mm256_loadu_pd(p)};
}
GAUSSMAP_INLINE void store_quad(double* p, Quad a) {
    _mm256_storeu_pd(p, a.v);
}
GAUSSMAP_INLINE Quad lesser(Quad a, Quad b) {
    return {_mm256_min_pd(a.v, b.v)};
}
GAUSSMAP_INLINE Quad greater(Quad a, Quad b) {
    return {_mm256_max_pd(a.v, b.v)};
}
GAUSSMAP_INLINE Quad reversed(Quad a) {
    return {_mm256_permute4x64_pd(a.v, 0x1b)};
}
GAUSSMAP_INLINE Quad low_halves(Quad a, Quad b) {  // a0 a1 b0 b1
    return {_mm256_insertf128_pd(a.v, _mm256_castpd256_pd128(b.v), 1)};
}
GAUSSMAP_INLINE Quad high_halves(Quad a, Quad b) {  // a2 a3 b2 b3
    return {_mm256_insertf128_pd(b.v, _mm256_extractf128_pd(a.v, 1), 0)};
}
GAUSSMAP_INLINE Quad evens(Quad a, Quad b) {  // a0 b0 a2 b2
    return {_mm256_unpacklo_pd(a.v, b.v)};
}
GAUSSMAP_INLINE Quad odds(Quad a, Quad b) {  // a1 b1 a3 b3
    return {_mm256_unpackhi_pd(a.v, b.v)};
}
#else
typedef double Half __attribute__((vector_size(16)));
typedef double HalfInMemory __attribute__((vector_size(16), aligned(8), may_alias));
struct Quad {
    Half low, high;
};
GAUSSMAP_INLINE Quad load_quad(const double* p) {
    return {*reinterpret_cast<const HalfInMemory*>(p), *reinterpret_cast<const HalfInMemory*>(p + 2)};
}
GAUSSMAP_INLINE void store_quad(double* p, Quad a) {
    *reinterpret_cast<HalfInMemory*>(p) = a.low, *reinterpret_cast<HalfInMemory*>(p + 2) = a.high;
}
#ifdef __SSE2__
GAUSSMAP_INLINE Quad lesser(Quad a, Quad b) {
    return {(Half)_mm_min_pd((__m128d)a.low, (__m128d)b.low), (Half)_mm_min_pd((__m128d)a.high, (__m128d)b.high)};
}
GAUSSMAP_INLINE Quad greater(Quad a, Quad b) {
    return {(Half)_mm_max_pd((__m128d)a.low, (__m128d)b.low), (Half)_mm_max_pd((__m128d)a.high, (__m128d)b.high)};
}
#else
GAUSSMAP_INLINE Quad lesser(Quad a, Quad b) {
    return {a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
}
GAUSSMAP_INLINE Quad greater(Quad a, Quad b) {
    return {a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}
#endif
GAUSSMAP_INLINE Quad reversed(Quad a) {
    return {__builtin_shufflevector(a.high, a.high, 1, 0), __builtin_shufflevector(a.low, a.low, 1, 0)};
}
GAUSSMAP_INLINE Quad low_halves(Quad a, Quad b) {
    return {a.low, b.low};
}
GAUSSMAP_INLINE Quad high_halves(Quad a, Quad b) {
    return {a.high, b.high};
}
GAUSSMAP_INLINE Quad evens(Quad a, Quad b) {
    return {__builtin_shufflevector(a.low, b.low, 0, 2), __builtin_shufflevector(a.high, b.high, 0, 2)};
}
GAUSSMAP_INLINE Quad odds(Quad a, Quad b) {
    return {__builtin_shufflevector(a.low, b.low, 1, 3), __builtin_shufflevector(a.high, b.high, 1, 3)};
}
#endif

GAUSSMAP_INLINE void compare(Quad& a, Quad& b) {
    const Quad least = lesser(a, b);
    b = greater(a, b);
    a = least;
}

/// The columns of four quads become rows.
GAUSSMAP_INLINE void transpose(const Quad& a, const Quad& b, const Quad& c, const Quad& d, Quad* row0, Quad* row1,
                               Quad* row2, Quad* row3) {
    const Quad ab = evens(a, b), cd = evens(c, d), ab1 = odds(a, b), cd1 = odds(c, d);
    *row0 = low_halves(ab, cd), *row1 = low_halves(ab1, cd1);
    *row2 = high_halves(ab, cd), *row3 = high_halves(ab1, cd1);
}

/// Sort N quads that are one bitonic sequence.
template <int N>
GAUSSMAP_INLINE void clean(Quad* q) {
    for (int i = 0; i < N / 2; ++i) compare(q[i], q[i + N / 2]);
    if constexpr (N > 2) {
        clean<N / 2>(q);
        clean<N / 2>(q + N / 2);
    } else {
        Quad a = low_halves(q[0], q[1]), b = high_halves(q[0], q[1]);
        compare(a, b);
        Quad c = evens(a, b), d = odds(a, b);
        compare(c, d);
        const Quad first = evens(c, d), second = odds(c, d);
        q[0] = low_halves(first, second), q[1] = high_halves(first, second);
    }
}

/// Merge the first and the second N quads, each sorted.
template <int N>
GAUSSMAP_INLINE void merge(Quad* q) {
    for (int i = 0; i < N / 2; ++i) {
        const Quad swapped = reversed(q[N + i]);
        q[N + i] = reversed(q[2 * N - 1 - i]);
        q[2 * N - 1 - i] = swapped;
    }
    for (int i = 0; i < N; ++i) compare(q[i], q[N + i]);
    clean<N>(q);
    clean<N>(q + N);
}

constexpr std::size_t sort_block = 32;

inline void sort_one_block(double* key) {
    Quad c[8], q[8];
    for (int i = 0; i < 8; ++i) c[i] = load_quad(key + 4 * i);
    constexpr int network[19][2] = {{0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {0, 1}, {2, 3},
                                    {4, 5}, {6, 7}, {2, 4}, {3, 5}, {1, 4}, {3, 6}, {1, 2}, {3, 4}, {5, 6}};
#pragma GCC unroll 19
    for (const auto& pair : network) compare(c[pair[0]], c[pair[1]]);
    transpose(c[0], c[1], c[2], c[3], &q[0], &q[2], &q[4], &q[6]);
    transpose(c[4], c[5], c[6], c[7], &q[1], &q[3], &q[5], &q[7]);
    merge<2>(q);
    merge<2>(q + 4);
    merge<4>(q);
    for (int i = 0; i < 8; ++i) store_quad(key + 4 * i, q[i]);
}

/// Merge two sorted runs, multiples of 16 long and not empty.
inline void merge_runs(const double* a, const double* a_end, const double* b, const double* b_end, double* to) {
    Quad q[8];
    for (int i = 0; i < 4; ++i) q[i] = load_quad(a + 4 * i), q[4 + i] = load_quad(b + 4 * i);
    a += 16, b += 16;
    for (;; to += 16) {
        merge<4>(q);
        for (int i = 0; i < 4; ++i) store_quad(to + 4 * i, q[i]);
        if (a == a_end && b == b_end) break;
        const bool from_a = b == b_end || (a != a_end && *a < *b);
        const double* const next = from_a ? a : b;
        for (int i = 0; i < 4; ++i) q[i] = load_quad(next + 4 * i);
        (from_a ? a : b) += 16;
    }
    for (int i = 4; i < 8; ++i) store_quad(to + 4 * i, q[i]);
}

/// Sort `count` keys, none of them NaN; both arrays have room up to the next multiple of 32. Returns the one of the two
/// that holds the result.
inline double* sort_keys(double* key, double* spare, std::size_t count) {
    const std::size_t end = (count + sort_block - 1) / sort_block * sort_block;
    for (std::size_t i = count; i < end; ++i) key[i] = infinity;
    for (std::size_t i = 0; i < end; i += sort_block) sort_one_block(key + i);
    for (std::size_t run = sort_block; run < end; run *= 2) {
        for (std::size_t i = 0; i < end; i += 2 * run) {
            const std::size_t last = i + 2 * run < end ? i + 2 * run : end;
            if (i + run < last)
                merge_runs(key + i, key + i + run, key + i + run, key + last, spare + i);
            else
                for (std::size_t j = i; j < last; ++j) spare[j] = key[j];
        }
        double* const sorted = spare;
        spare = key, key = sorted;
    }
    return key;
}

}  // namespace
}  // namespace gaussmap
