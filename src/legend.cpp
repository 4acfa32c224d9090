#include "legend.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "colormap.h"
#include "lettering.h"

namespace gaussmap {
namespace {

constexpr Ink dark = {44, 48, 56}, soft = {110, 114, 122};

/// Height of a capital: everything else is measured in it.
double capital_of(int width, int height) {
    return std::clamp(std::sqrt(static_cast<double>(width) * height) / 78, 7.0, 60.0);
}

void fill(Picture& picture, int x, int y0, int y1, Ink color) {
    if (x < 0 || x >= picture.width) return;
    for (int y = std::max(0, y0); y < std::min(y1, picture.height); ++y)
        std::copy(color.begin(), color.end(), &picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width + x)]);
}

struct Bar {
    double left, width, top, height;
};

/// The colours, with a point at an end beyond which there are values.
void draw_bar(Picture& picture, const Bar& bar, const Legend& legend) {
    const int first = static_cast<int>(std::lround(bar.left)), columns = static_cast<int>(std::lround(bar.width));
    const int top = static_cast<int>(std::lround(bar.top)), height = static_cast<int>(std::lround(bar.height));
    const auto color = [&](double t) { return color_of_range(legend.low, legend.high, legend.diverging, t); };
    for (int i = 0; i < columns; ++i) fill(picture, first + i, top, top + height, color((i + 0.5) / columns));
    const int tip = (height + 1) / 2;
    for (int i = 0; i < tip; ++i) {
        if (legend.above) fill(picture, first + columns + i, top + i, top + height - i, color(1));
        if (legend.below) fill(picture, first - 1 - i, top + i, top + height - i, color(0));
    }
}

void write_centred(Picture& picture, const std::string& text, double x, double y, double capital, Ink ink) {
    write_text(picture, text, x - text_width(text, capital) / 2, y, capital, ink);
}

std::string grouped(std::size_t n) {
    std::string text = std::to_string(n);
    for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), ",");
    return text;
}

/// A square of grey and how many values it stands for, to the right of the bar where there is room, else left out of
/// the way under it.
void draw_undefined(Picture& picture, const Legend& legend, double x, double y, double capital) {
    const std::string text = "undefined: " + grouped(legend.undefined);
    const int size = static_cast<int>(std::lround(1.1 * capital)), left = static_cast<int>(std::lround(x));
    for (int i = 0; i < size; ++i)
        fill(picture, left + i, static_cast<int>(std::lround(y)) - size, static_cast<int>(std::lround(y)),
             color_at(std::nan("")));
    write_text(picture, text, x + 1.8 * capital, y, 0.9 * capital, dark);
}

}  // namespace

std::vector<double> ticks(double low, double high) {
    const double range = high - low;
    const auto power = static_cast<int>(std::floor(std::log10(range / 5)));
    const double ten = std::pow(10.0, std::abs(power));
    // Multiples of a power of ten, divided where it is negative: 3/10 is the double nearest to 0.3, 3 · 0.1 is not.
    const auto value = [&](double multiple) { return power < 0 ? multiple / ten : multiple * ten; };
    double step = 1;
    for (const double candidate : {2.0, 5.0, 10.0})
        if (range / value(step) > 6) step = candidate;
    std::vector<double> out;
    const double slack = 1e-9 * range;
    for (double i = std::ceil((low - slack) / value(step)); value(i * step) <= high + slack && out.size() < 8; ++i)
        out.push_back(value(i * step));
    return out;
}

std::string tick_text(double value) {
    if (value == 0) return "0";
    char buffer[32];
    const double size = std::abs(value);
    const auto form = size >= 1e5 || size < 1e-3 ? std::chars_format::scientific : std::chars_format::fixed;
    // Rounded to six digits first, so that no tail of a binary fraction shows.
    const auto rounded = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific, 5);
    double six = 0;
    std::from_chars(buffer, rounded.ptr, six);
    std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, six, form).ptr);
    const std::size_t e = text.find('e');
    if (e == std::string::npos) return text;
    // "1e-05" as people write it: 1e-5.
    std::string exponent = text.substr(e + 1);
    const bool negative = exponent[0] == '-';
    exponent.erase(0, exponent.find_first_not_of("+-0"));
    return text.substr(0, e) + (negative ? "e-" : "e") + exponent;
}

int legend_height(int width, int height) {
    if (width < 200 || height < 200) return 0;
    return static_cast<int>(std::lround(7.2 * capital_of(width, height)));
}

void draw_legend(Picture& picture, const Legend& legend) {
    const int strip = legend_height(picture.width, picture.height);
    if (strip == 0) return;
    const double capital = capital_of(picture.width, picture.height);
    const double top = picture.height - strip;
    const std::string unit = legend.unit.empty() ? "" : "   (" + legend.unit + ")";
    // A label too long for the picture is written smaller.
    const double wanted = text_width(legend.label + unit, capital);
    const double letter = capital * std::min(1.0, 0.94 * picture.width / std::max(wanted, 1.0));
    const double start = (picture.width - text_width(legend.label + unit, letter)) / 2;
    write_text(picture, legend.label, start, top + 1.2 * capital, letter, dark);
    if (!unit.empty())
        write_text(picture, unit, picture.width - start - text_width(unit, letter), top + 1.2 * capital, letter, soft);

    if (legend.undefined < legend.values) {
        const double width = std::min(0.46 * picture.width, 40 * capital);
        const Bar bar = {(picture.width - width) / 2, width, top + 2.2 * capital, 1.1 * capital};
        draw_bar(picture, bar, legend);
        const double bottom = bar.top + bar.height;
        for (const double tick : ticks(legend.low, legend.high)) {
            const double x = bar.left + bar.width * (tick - legend.low) / (legend.high - legend.low);
            draw_line(picture, x, bottom + 0.15 * capital, x, bottom + 0.45 * capital, std::max(1.0, 0.1 * capital),
                      soft);
            write_centred(picture, tick_text(tick), x, bottom + 1.8 * capital, 0.9 * capital, dark);
        }
        if (legend.undefined > 0) draw_undefined(picture, legend, bar.left + bar.width + 3 * capital, bottom, capital);
    } else {
        draw_undefined(picture, legend, picture.width / 2.0 - 6 * capital, top + 3.5 * capital, capital);
    }
}

}  // namespace gaussmap
