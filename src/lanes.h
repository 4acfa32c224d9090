// Four doubles that are worked on side by side, in whatever registers the target has. Sums over neighbours are kept in
// four lanes and added up in one order, so every target gives the same bits.
#pragma once

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // how lanes are passed does not matter: everything that takes them is inlined
#endif

#include <cstddef>
#include <vector>

namespace gaussmap {

constexpr std::size_t lanes = 4;

typedef double Four __attribute__((vector_size(32)));
typedef double FourInMemory __attribute__((vector_size(32), aligned(8), may_alias));
typedef long long FourMask __attribute__((vector_size(32)));  ///< all ones where true

#define GAUSSMAP_LANES inline __attribute__((always_inline))

GAUSSMAP_LANES Four load_four(const double* p) {
    return *reinterpret_cast<const FourInMemory*>(p);
}
GAUSSMAP_LANES void store_four(double* p, const Four& a) {
    *reinterpret_cast<FourInMemory*>(p) = a;
}
GAUSSMAP_LANES double total(const Four& a) {
    return (a[0] + a[1]) + (a[2] + a[3]);
}
GAUSSMAP_LANES Four absolute(const Four& a) {
    return (Four)((FourMask)a & 0x7fffffffffffffff);
}

/// `count` rounded up to whole groups of lanes.
constexpr std::size_t padded(std::size_t count) {
    return (count + lanes - 1) / lanes * lanes;
}

/// Σ a b over `count` entries, a multiple of `lanes`.
GAUSSMAP_LANES double product(const double* a, const double* b, std::size_t count) {
    Four sum = {};
    for (std::size_t j = 0; j < count; j += lanes) sum += load_four(a + j) * load_four(b + j);
    return total(sum);
}

}  // namespace gaussmap
