// Colours for densities: dark violet through teal to bright yellow, in steps that look equal.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gaussmap/io.h"

namespace cli {

/// Of a value in [0, 1]; outside it the ends, NaN a neutral grey. Lightness grows evenly, so it survives grey printing.
std::array<std::uint8_t, 3> color_of(double value);

/// Properties red, green and blue (uint8) of values between 0 and `top`.
std::array<gaussmap::Property, 3> color_properties(const std::vector<double>& values, double top);

}  // namespace cli
