// Colours of the library's colour map as properties of a file.
#pragma once

#include <array>
#include <vector>

#include "gaussmap/io.h"

namespace cli {

/// Properties red, green and blue (uint8) of values between 0 and `top`.
std::array<gaussmap::Property, 3> color_properties(const std::vector<double>& values, double top);

}  // namespace cli
