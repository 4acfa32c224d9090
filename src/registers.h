// Doubles in the widest registers of an instruction set. Part of the kernels that include it, one for each instruction
// set; without external linkage, or the linker could pick a copy that the machine cannot run.
#pragma once

#ifdef __SSE2__
#include <immintrin.h>
#endif

#define GAUSSMAP_INLINE inline __attribute__((always_inline))

namespace gaussmap {
namespace {

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

// What compilers do not make one instruction of.
#if defined __AVX2__
GAUSSMAP_INLINE Real select(Mask mask, Real yes, Real no) {
    return (Real)_mm256_blendv_pd((__m256d)no, (__m256d)yes, (__m256d)mask);
}
GAUSSMAP_INLINE Real maximum(Real a, Real b) {
    return (Real)_mm256_max_pd((__m256d)a, (__m256d)b);
}
GAUSSMAP_INLINE Real minimum(Real a, Real b) {
    return (Real)_mm256_min_pd((__m256d)a, (__m256d)b);
}
GAUSSMAP_INLINE Real square_root(Real a) {
    return (Real)_mm256_sqrt_pd((__m256d)a);
}
/// A bit a lane.
GAUSSMAP_INLINE unsigned bits_of(Mask mask) {
    return static_cast<unsigned>(_mm256_movemask_pd((__m256d)mask));
}
#else
GAUSSMAP_INLINE Real select(Mask mask, Real yes, Real no) {
    return (Real)((mask & (Mask)yes) | (~mask & (Mask)no));
}
#ifdef __SSE2__
GAUSSMAP_INLINE Real maximum(Real a, Real b) {
    return (Real)_mm_max_pd((__m128d)a, (__m128d)b);
}
GAUSSMAP_INLINE Real minimum(Real a, Real b) {
    return (Real)_mm_min_pd((__m128d)a, (__m128d)b);
}
GAUSSMAP_INLINE Real square_root(Real a) {
    return (Real)_mm_sqrt_pd((__m128d)a);
}
GAUSSMAP_INLINE unsigned bits_of(Mask mask) {
    return static_cast<unsigned>(_mm_movemask_pd((__m128d)mask));
}
#else
GAUSSMAP_INLINE Real maximum(Real a, Real b) {
    return a > b ? a : b;
}
GAUSSMAP_INLINE Real minimum(Real a, Real b) {
    return a < b ? a : b;
}
GAUSSMAP_INLINE Real square_root(Real a) {
    Real root;
    for (int l = 0; l < lanes; ++l) root[l] = __builtin_sqrt(a[l]);
    return root;
}
GAUSSMAP_INLINE unsigned bits_of(Mask mask) {
    unsigned bits = 0;
    for (int l = 0; l < lanes; ++l) bits |= static_cast<unsigned>(mask[l] & 1) << l;
    return bits;
}
#endif
#endif

}  // namespace
}  // namespace gaussmap
