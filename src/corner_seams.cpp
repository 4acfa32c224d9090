// Where values of corners tear: sides with two faces that do not agree on the values at both ends.
#include <algorithm>
#include <utility>

#include "check.h"
#include "gaussmap/decimate.h"

namespace gaussmap {

std::vector<std::uint8_t> corner_seams(Triangles faces, const std::vector<double>& values, std::size_t components) {
    check_count("values", values.size(), 3 * faces.count * components, "numbers of corners");
    struct Side {
        std::int32_t low, high;                 ///< vertices
        std::size_t opposite, at_low, at_high;  ///< corners
    };
    std::vector<Side> sides;
    sides.reserve(3 * faces.count);
    for (std::size_t f = 0; f < faces.count; ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            if (faces[f][i] > faces[f][j]) std::swap(i, j);
            sides.push_back({faces[f][i], faces[f][j], 3 * f + k, 3 * f + i, 3 * f + j});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.opposite < b.opposite;
    });
    const auto equal = [&](std::size_t one, std::size_t other) {
        return std::equal(&values[components * one], &values[components * one] + components,
                          &values[components * other]);
    };
    std::vector<std::uint8_t> seams(3 * faces.count, 0);
    bool any = false;
    for (std::size_t i = 1; i < sides.size(); ++i) {
        const Side &a = sides[i - 1], &b = sides[i];
        if (a.low != b.low || a.high != b.high) continue;
        if (equal(a.at_low, b.at_low) && equal(a.at_high, b.at_high)) continue;
        seams[a.opposite] = seams[b.opposite] = 1;
        any = true;
    }
    return any ? seams : std::vector<std::uint8_t>{};
}

}  // namespace gaussmap
