// The bar of colours under a picture: what they mean, in numbers and a unit.
#pragma once

#include <string>
#include <vector>

#include "gaussmap/picture.h"

namespace gaussmap {

struct Legend {
    std::string label, unit;
    double low = 0, high = 1;
    bool below = false, above = false;  ///< there are values beyond the ends
    std::size_t undefined = 0, values = 0;
    bool diverging = false;
};

/// Pixels that the legend takes at the bottom of a picture of this size; 0 where it is too small to read one.
int legend_height(int width, int height);

void draw_legend(Picture& picture, const Legend& legend);

/// Round values between low and high, three to seven of them: steps of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(double low, double high);

/// "12", "0.5", "1e-4", at most six digits.
std::string tick_text(double value);

}  // namespace gaussmap
