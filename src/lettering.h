// Words and numbers on a picture, in a stroke alphabet of our own: sharp at any size, no font needed.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "gaussmap/picture.h"

namespace gaussmap {

using Ink = std::array<std::uint8_t, 3>;

/// Width of a line of UTF-8 text whose capitals are `capital` pixels high.
double text_width(std::string_view text, double capital);

/// Write it, beginning at x, standing on the line y (pixels from the top).
void write_text(Picture& picture, std::string_view text, double x, double y, double capital, Ink ink);

/// A straight line with round ends, `width` pixels wide.
void draw_line(Picture& picture, double x0, double y0, double x1, double y1, double width, Ink ink);

}  // namespace gaussmap
