// Lightness, chroma and hue move evenly in OKLab, whose distances are close to how different colours look:
// Björn Ottosson, "A perceptual color space for image processing", 2020 (the matrices below are that page's).
#include "colormap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gaussmap {
namespace {

// The sRGB standard, IEC 61966-2-1.
double decode(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
double encode(double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

std::uint8_t byte_of(double linear) {
    return static_cast<std::uint8_t>(std::lround(255 * encode(std::clamp(linear, 0.0, 1.0))));
}

std::array<std::uint8_t, 3> from_oklch(double lightness, double chroma, double hue) {
    const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
    const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
    const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
    const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
    return {byte_of(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            byte_of(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            byte_of(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

LinearRgb linear_color(std::array<std::uint8_t, 3> color) {
    return {linear_of(color[0]), linear_of(color[1]), linear_of(color[2])};
}

}  // namespace

std::array<std::uint8_t, 3> color_at(double value) {
    if (std::isnan(value)) return {128, 128, 128};
    const double t = std::clamp(value, 0.0, 1.0);
    const double middle = 1 - (2 * t - 1) * (2 * t - 1);  // teal cannot be as vivid as the ends are
    const double chroma = (t < 0.5 ? 0.14 : 0.16) * (1 - middle) + 0.1 * middle;
    return from_oklch(0.37 + 0.56 * t, chroma, (295 - 190 * t) * std::numbers::pi / 180);
}

std::array<std::uint8_t, 3> diverging_color_at(double value) {
    if (std::isnan(value)) return color_at(value);
    const double t = std::min(std::abs(value), 1.0);
    return from_oklch(0.93 - 0.48 * t, 0.16 * t, (value < 0 ? 255 : 30) * std::numbers::pi / 180);
}

std::array<std::uint8_t, 3> color_of_range(double low, double high, bool diverging, double fraction) {
    if (!diverging) return color_at(fraction);
    return diverging_color_at((low + fraction * (high - low)) / std::max(std::abs(low), std::abs(high)));
}

float linear_of(std::uint8_t encoded) {
    static const auto table = [] {
        std::array<float, 256> t{};
        for (int i = 0; i < 256; ++i) t[i] = static_cast<float>(decode(i / 255.0));
        return t;
    }();
    return table[encoded];
}

std::uint8_t encoded_of(float linear) {
    // Fine enough to return every byte that linear_of took: a fifth of a byte where the curve is steepest.
    constexpr int steps = 16384;
    static const auto table = [] {
        std::array<std::uint8_t, steps + 1> t{};
        for (int i = 0; i <= steps; ++i) t[i] = byte_of(i / static_cast<double>(steps));
        return t;
    }();
    return table[static_cast<std::size_t>(std::lrint(std::clamp(linear, 0.0F, 1.0F) * steps))];
}

Ramp::Ramp(double low, double high, bool diverging)
    : low_(low), scale_(1 / (high - low)), undefined_(linear_color(color_at(std::nan("")))) {
    colors_.reserve(steps + 1);
    for (int i = 0; i <= steps; ++i)
        colors_.push_back(linear_color(color_of_range(low, high, diverging, i / static_cast<double>(steps))));
}

}  // namespace gaussmap
