// Lightness, chroma and hue move evenly in OKLab, whose distances are close to how different colours look:
// Björn Ottosson, "A perceptual color space for image processing", 2020 (the matrices below are that page's).
#include "colormap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cli {
namespace {

std::uint8_t encode(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return static_cast<std::uint8_t>(
        std::lround(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055)));
}

std::array<std::uint8_t, 3> from_oklch(double lightness, double chroma, double hue) {
    const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
    const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
    const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
    const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
    return {encode(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

}  // namespace

std::array<std::uint8_t, 3> color_of(double value) {
    if (std::isnan(value)) return {128, 128, 128};
    const double t = std::clamp(value, 0.0, 1.0);
    const double middle = 1 - (2 * t - 1) * (2 * t - 1);  // teal cannot be as vivid as the ends are
    const double chroma = (t < 0.5 ? 0.12 : 0.16) * (1 - middle) + 0.1 * middle;
    return from_oklch(0.28 + 0.64 * t, chroma, (300 - 195 * t) * std::numbers::pi / 180);
}

std::array<gaussmap::Property, 3> color_properties(const std::vector<double>& values, double top) {
    constexpr const char* names[] = {"red", "green", "blue"};
    std::array<gaussmap::Property, 3> out;
    for (std::size_t c = 0; c < 3; ++c) {
        out[c].name = names[c];
        out[c].type = gaussmap::Type::uint8;
        out[c].bytes.reserve(values.size());
    }
    for (const double value : values) {
        // With nothing above 0 (a plane) every value is the bottom of the scale.
        const auto color = color_of(top > 0 || std::isnan(value) ? value / top : 0);
        for (std::size_t c = 0; c < 3; ++c) out[c].bytes.push_back(static_cast<std::byte>(color[c]));
    }
    return out;
}

}  // namespace cli
