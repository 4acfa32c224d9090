#include "io/text.h"

#include <limits>

namespace gaussmap::io {

namespace {

/// A leading plus is fine in files but unknown to from_chars.
std::string_view without_plus(std::string_view word) {
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    return plus ? word.substr(1) : word;
}

/// Whether a decimal number known to lie outside the range of double is beyond it rather than below it: the sign of the
/// power of ten of its first digit that is not 0.
bool is_huge(std::string_view word) {
    const std::size_t e = word.find_first_of("eE");
    const std::string_view digits = word.substr(0, e);
    const std::size_t first = digits.find_first_of("123456789");
    const std::size_t point = std::min(digits.find('.'), digits.size());
    const auto places = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
    if (first == std::string_view::npos) return false;
    if (e == std::string_view::npos) return places > 0;
    const std::string_view exponent = without_plus(word.substr(e + 1));
    std::int64_t power = 0;
    if (std::from_chars(exponent.data(), exponent.data() + exponent.size(), power).ec == std::errc()) {
        return power > -places;
    }
    return exponent[0] != '-';
}

template <class Number>
void append(std::string& out, Number value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    static_cast<void>(error);  // 32 characters hold the shortest form of every value
    out.append(text, end);
}

}  // namespace

bool parse(std::string_view word, double& value) {
    word = without_plus(word);
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (end != last || word.empty()) return false;
    if (error == std::errc()) return true;
    if (error != std::errc::result_out_of_range) return false;
    const double magnitude = is_huge(word) ? std::numeric_limits<double>::infinity() : 0;
    value = word[0] == '-' ? -magnitude : magnitude;
    return true;
}

bool parse(std::string_view word, std::int64_t& value) {
    word = without_plus(word);
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    return error == std::errc() && end == last && !word.empty();
}

void append_number(std::string& out, double value, Type type) {
    if (std::isnan(value)) {
        out += "nan";
    } else if (type == Type::float32) {
        append(out, static_cast<float>(value));
    } else if (type == Type::float64) {
        append(out, value);
    } else if (type == Type::uint64) {
        append(out, static_cast<std::uint64_t>(value));
    } else {
        append(out, static_cast<std::int64_t>(value));
    }
}

}  // namespace gaussmap::io
