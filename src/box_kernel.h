// Doubles in the widest registers of an instruction set, and distances of boxes. Part of the kernels that include it,
// one for each instruction set; without external linkage, or the linker could pick a copy that the machine cannot run.
#pragma once

#ifdef __SSE2__
#include <immintrin.h>
#endif

#include <cstddef>

namespace gaussmap {
namespace {

#define GAUSSMAP_INLINE inline __attribute__((always_inline))

#ifdef __AVX2__
constexpr int lanes = 4;
#else
constexpr int lanes = 2;
#endif
typedef double Real __attribute__((vector_size(8 * lanes)));
typedef double RealInMemory __attribute__((vector_size(8 * lanes), aligned(8), may_alias));
typedef long long Mask __attribute__((vector_size(8 * lanes)));

GAUSSMAP_INLINE Real load(const double* p) {
    return *reinterpret_cast<const RealInMemory*>(p);
}
GAUSSMAP_INLINE void store(double* p, Real a) {
    *reinterpret_cast<RealInMemory*>(p) = a;
}
GAUSSMAP_INLINE Real all(double a) {
    return Real{} + a;
}

GAUSSMAP_INLINE Real maximum(Real a, Real b) {
#if defined __AVX2__
    return (Real)_mm256_max_pd((__m256d)a, (__m256d)b);
#elif defined __SSE2__
    return (Real)_mm_max_pd((__m128d)a, (__m128d)b);
#else
    return a > b ? a : b;
#endif
}

/// A bit a lane.
GAUSSMAP_INLINE unsigned bits_of(Mask mask) {
#if defined __AVX2__
    return static_cast<unsigned>(_mm256_movemask_pd((__m256d)mask));
#elif defined __SSE2__
    return static_cast<unsigned>(_mm_movemask_pd((__m128d)mask));
#else
    unsigned bits = 0;
    for (int l = 0; l < lanes; ++l) bits |= static_cast<unsigned>(mask[l] & 1) << l;
    return bits;
#endif
}

struct Box {
    double low[3], high[3];
};

/// Bounds of squared distances between points of one box and points of others: rounding is monotone, so they hold in
/// floating point too.
GAUSSMAP_INLINE Real gap(const Box& box, const double* const (&low)[3], const double* const (&high)[3], std::size_t i) {
    Real sum = Real{};
    for (int a = 0; a < 3; ++a) {
        const Real d = maximum(maximum(load(low[a] + i) - box.high[a], box.low[a] - load(high[a] + i)), Real{});
        sum = a == 0 ? d * d : sum + d * d;
    }
    return sum;
}

#undef GAUSSMAP_INLINE

}  // namespace
}  // namespace gaussmap
