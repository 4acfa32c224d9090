// Colours of vertices and faces: the uint8 properties red green blue and perhaps alpha.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/rows.h"
#include "io/types.h"

namespace gaussmap::io {

inline constexpr std::array<const char*, 4> color_names = {"red", "green", "blue", "alpha"};

/// Add the colours of a text file (`channels` values an item, red first), which are fractions or run to 255.
/// NaN becomes 0; values that are no colours at all are left out; either is noted.
inline void add_colors(Geometry& geometry, std::vector<Property>& properties, const std::vector<double>& values,
                       std::size_t channels, bool fractions) {
    const double top = fractions ? 1 : 255;
    if (std::any_of(values.begin(), values.end(), [&](double v) { return v < 0 || v > top; })) {
        geometry.notes.push_back("colours outside 0 to 255 left out");
        return;
    }
    const auto undefined = std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); });
    if (undefined > 0) {
        geometry.notes.push_back(counted(static_cast<std::size_t>(undefined), "colour value") +
                                 " not a number: set to 0");
    }
    std::vector<double> channel(values.size() / channels);
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < channel.size(); ++i) channel[i] = values[i * channels + c] * (255 / top);
        properties.push_back(make_property(color_names[c], channel, Type::uint8));
    }
}

/// Whether colours of unknown range are fractions: nothing is above 1.
inline bool are_fractions(const std::vector<double>& values) {
    return std::none_of(values.begin(), values.end(), [](double v) { return v > 1; });
}

/// The colours among the properties: 3 or 4 channels in order, or none.
inline std::vector<const Property*> find_colors(const std::vector<Property>& properties) {
    std::vector<const Property*> channels;
    for (const char* name : color_names) {
        const auto found = std::find_if(properties.begin(), properties.end(), [&](const Property& p) {
            return p.name == name && p.type == Type::uint8 && !p.list;
        });
        if (found == properties.end()) break;
        channels.push_back(&*found);
    }
    if (channels.size() < 3) channels.clear();
    return channels;
}

}  // namespace gaussmap::io
