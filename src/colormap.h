// Colours in linear light, where they may be added and shaded.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "gaussmap/picture.h"

namespace gaussmap {

struct LinearRgb {
    float r = 0, g = 0, b = 0;
};

/// Of an sRGB byte, 0 to 1; and back, rounded.
float linear_of(std::uint8_t encoded);
std::uint8_t encoded_of(float linear);

/// The colour at a fraction in [0, 1] of the range from `low` to `high`.
std::array<std::uint8_t, 3> color_of_range(double low, double high, bool diverging, double fraction);

/// The colours of values between `low` and `high`, looked up.
class Ramp {
  public:
    Ramp(double low, double high, bool diverging);

    const LinearRgb& operator()(double value) const {
        const double t = (value - low_) * scale_;
        // Written so that NaN takes the first branch.
        return !(t > 0) ? colors_.front()
               : t >= 1 ? colors_.back()
                        : colors_[static_cast<std::size_t>(std::lrint(t * steps))];
    }
    const LinearRgb& undefined() const { return undefined_; }

  private:
    static constexpr int steps = 1024;
    double low_, scale_;
    std::vector<LinearRgb> colors_;
    LinearRgb undefined_;
};

}  // namespace gaussmap
