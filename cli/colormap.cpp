#include "colormap.h"

#include <cmath>

#include "gaussmap/picture.h"

namespace cli {

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
        const auto color = gaussmap::color_at(top > 0 || std::isnan(value) ? value / top : 0);
        for (std::size_t c = 0; c < 3; ++c) out[c].bytes.push_back(static_cast<std::byte>(color[c]));
    }
    return out;
}

}  // namespace cli
