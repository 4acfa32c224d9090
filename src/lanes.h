// Doubles that are worked on side by side: two in a register, as any x86-64 has them, and four in two. Sums over
// neighbours are kept in four lanes and added up in one order, so that every target gives the same bits.
#pragma once

#include <cstddef>

namespace gaussmap {

#define GAUSSMAP_LANES inline __attribute__((always_inline))

typedef double Two __attribute__((vector_size(16)));
typedef double TwoInMemory __attribute__((vector_size(16), aligned(8), may_alias));
typedef long long TwoMask __attribute__((vector_size(16)));  ///< all ones where true

GAUSSMAP_LANES Two load_two(const double* p) {
    return *reinterpret_cast<const TwoInMemory*>(p);
}
GAUSSMAP_LANES void store_two(double* p, Two a) {
    *reinterpret_cast<TwoInMemory*>(p) = a;
}
GAUSSMAP_LANES Two absolute(Two a) {
    return (Two)((TwoMask)a & 0x7fffffffffffffff);
}
GAUSSMAP_LANES Two select(TwoMask mask, Two yes, Two no) {
    return (Two)((mask & (TwoMask)yes) | (~mask & (TwoMask)no));
}

constexpr std::size_t lanes = 4;

/// Not one vector of four: without AVX compilers keep such a vector in memory.
struct Four {
    Two low = {}, high = {};
};
GAUSSMAP_LANES Four load_four(const double* p) {
    return {load_two(p), load_two(p + 2)};
}
GAUSSMAP_LANES void store_four(double* p, Four a) {
    store_two(p, a.low);
    store_two(p + 2, a.high);
}
GAUSSMAP_LANES Four operator+(Four a, Four b) {
    return {a.low + b.low, a.high + b.high};
}
GAUSSMAP_LANES Four operator-(Four a, Four b) {
    return {a.low - b.low, a.high - b.high};
}
GAUSSMAP_LANES Four operator*(Four a, Four b) {
    return {a.low * b.low, a.high * b.high};
}
GAUSSMAP_LANES Four operator*(Four a, double s) {
    return {a.low * s, a.high * s};
}
GAUSSMAP_LANES Four& operator+=(Four& a, Four b) {
    return a = a + b;
}
GAUSSMAP_LANES double total(Four a) {
    const Two sum = a.low + a.high;
    return sum[0] + sum[1];
}

/// `count` rounded up to whole groups of lanes.
constexpr std::size_t padded(std::size_t count) {
    return (count + lanes - 1) / lanes * lanes;
}

/// Σ a b over `count` entries, a multiple of `lanes`.
GAUSSMAP_LANES double product(const double* a, const double* b, std::size_t count) {
    Four sum;
    for (std::size_t j = 0; j < count; j += lanes) sum += load_four(a + j) * load_four(b + j);
    return total(sum);
}

}  // namespace gaussmap
