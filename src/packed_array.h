// Arrays made small for a page: differences, split into planes of bytes, deflated, in base64.
//
// Neighbouring vertices lie close together and neighbouring faces share vertices, so differences are small, their high
// bytes are nearly all alike, and deflate finds them when they stand side by side.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// Items of a block; each block stands alone, so that blocks are packed side by side.
constexpr std::size_t packed_block = 1 << 18;

enum class Differences {
    columns,    ///< each number from the one above it, 0 for the first of a block
    triangles,  ///< a from the a above, b and c from a
};

/// Rows of `columns` numbers, Word being their bits. Of each block: zigzag differences modulo 2^bits, then for every
/// column and every byte from the lowest a plane of that byte of all rows; deflated (zlib, RFC 1950), in base64.
/// \throw std::runtime_error without zlib.
template <class Word>
std::vector<std::string> packed(std::span<const Word> numbers, std::size_t columns, Differences differences,
                                const Execution& run);

extern template std::vector<std::string> packed(std::span<const std::uint16_t>, std::size_t, Differences,
                                                const Execution&);
extern template std::vector<std::string> packed(std::span<const std::uint32_t>, std::size_t, Differences,
                                                const Execution&);
extern template std::vector<std::string> packed(std::span<const std::uint64_t>, std::size_t, Differences,
                                                const Execution&);

/// Was the library built with zlib?
bool can_pack();

}  // namespace gaussmap
