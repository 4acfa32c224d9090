// Checks of scalar arguments; messages name the function, the parameter and the value: "torus: minor = 2 must be …".
#pragma once

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

namespace gaussmap {

/// A number in its shortest form.
template <class Number>
std::string shown(Number value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

/// \throw std::invalid_argument "`function`: `parameter` = `value` must `rule`" unless `holds`.
template <class Number>
void require(bool holds, const char* function, const char* parameter, Number value, const std::string& rule) {
    if (holds) return;
    throw std::invalid_argument(std::string(function) + ": " + parameter + " = " + shown(value) + " must " + rule);
}

inline void require_positive(const char* function, const char* parameter, double value) {
    require(std::isfinite(value) && value > 0, function, parameter, value, "be positive and finite");
}

}  // namespace gaussmap
