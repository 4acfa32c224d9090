// Numbers to text and back, as libstdc++ does it: digits by fmt (shortest) and by the C library (a given precision).
#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

std::to_chars_result put(char* first, char* last, const std::string& text) {
    if (static_cast<std::size_t>(last - first) < text.size()) return {last, std::errc::value_too_large};
    std::memcpy(first, text.data(), text.size());
    return {first + text.size(), std::errc()};
}

/// A finite number other than 0: ± 0.d1d2… · 10^point.
struct Decimal {
    bool negative = false;
    std::string digits;
    int point = 0;
};

template <class Float>
Decimal shortest(Float value) {
    Decimal out;
    out.negative = std::signbit(value);
    const std::string text = fmt::format("{}", std::abs(value));
    const std::size_t e = text.find('e');
    const std::string mantissa = text.substr(0, e);
    const int power = e == std::string::npos ? 0 : std::atoi(text.c_str() + e + 1);
    const std::size_t dot = std::min(mantissa.find('.'), mantissa.size());
    out.point = static_cast<int>(dot) + power;
    for (const char c : mantissa)
        if (c != '.') out.digits += c;
    const std::size_t zeros = out.digits.find_first_not_of('0');
    out.digits.erase(0, zeros);
    out.point -= static_cast<int>(zeros);
    out.digits.erase(out.digits.find_last_not_of('0') + 1);
    return out;
}

std::string fixed(const Decimal& d, double value) {
    const int n = static_cast<int>(d.digits.size());
    // Of integers all digits, not the shortest ones and zeros.
    if (d.point >= n) return fmt::format("{:.0f}", value);
    const std::string sign = d.negative ? "-" : "";
    if (d.point <= 0) return sign + "0." + std::string(static_cast<std::size_t>(-d.point), '0') + d.digits;
    const auto whole = static_cast<std::size_t>(d.point);
    return sign + d.digits.substr(0, whole) + "." + d.digits.substr(whole);
}

std::string scientific(const Decimal& d) {
    const std::string rest = d.digits.size() > 1 ? "." + d.digits.substr(1) : "";
    const int power = d.point - 1;
    return fmt::format("{}{}{}e{}{:02}", d.negative ? "-" : "", d.digits[0], rest, power < 0 ? '-' : '+',
                       std::abs(power));
}

/// Zero and what is not finite have one form each; empty for all others.
std::string special(double value) {
    const std::string sign = std::signbit(value) ? "-" : "";
    if (std::isnan(value)) return sign + "nan";
    if (std::isinf(value)) return sign + "inf";
    return value == 0 ? sign + "0" : "";
}

template <class Float>
std::to_chars_result put_shortest(char* first, char* last, Float value) {
    if (const std::string text = special(value); !text.empty()) return put(first, last, text);
    const Decimal d = shortest(value);
    const std::string a = fixed(d, value), b = scientific(d);
    return put(first, last, a.size() <= b.size() ? a : b);
}

/// The end of the longest number at `at`, in the grammar of from_chars; `at` itself where there is none.
const char* end_of_number(const char* at, const char* last) {
    const char* const begin = at;
    if (at != last && *at == '-') ++at;
    for (const char* const word : {"infinity", "inf", "nan"}) {
        const std::size_t n = std::strlen(word);
        if (static_cast<std::size_t>(last - at) >= n && ::strncasecmp(at, word, n) == 0) return at + n;
    }
    const auto digits = [&] {
        const char* const from = at;
        while (at != last && *at >= '0' && *at <= '9') ++at;
        return at != from;
    };
    bool any = digits();
    if (at != last && *at == '.') {
        ++at;
        any = digits() || any;
    }
    if (!any) return begin;
    const char* const mantissa = at;
    if (at == last || (*at != 'e' && *at != 'E')) return mantissa;
    ++at;
    if (at != last && (*at == '-' || *at == '+')) ++at;
    return digits() ? at : mantissa;
}

template <class Float>
std::from_chars_result parse(const char* first, const char* last, Float& value, Float (*convert)(const char*, char**)) {
    const char* const end = end_of_number(first, last);
    if (end == first) return {first, std::errc::invalid_argument};
    const std::string text(first, end);
    const Float parsed = convert(text.c_str(), nullptr);
    // Zero or infinity of a text that says neither.
    const bool zero = text.substr(0, text.find_first_of("eE")).find_first_of("123456789") == std::string::npos;
    const bool word = text.find_first_of("iInN") != std::string::npos;
    if (!word && ((parsed == 0 && !zero) || std::isinf(parsed))) return {end, std::errc::result_out_of_range};
    value = parsed;
    return {end, std::errc()};
}

}  // namespace

namespace std {

to_chars_result to_chars(char* first, char* last, double value) {
    return put_shortest(first, last, value);
}
to_chars_result to_chars(char* first, char* last, float value) {
    return put_shortest(first, last, value);
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format) {
    if (value == 0 && format == chars_format::scientific) return put(first, last, signbit(value) ? "-0e+00" : "0e+00");
    if (const string text = special(value); !text.empty()) return put(first, last, text);
    const Decimal d = shortest(value);
    return put(first, last, format == chars_format::scientific ? scientific(d) : fixed(d, value));
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision) {
    return put(first, last,
               format == chars_format::scientific ? fmt::format("{:.{}e}", value, precision)
                                                  : fmt::format("{:.{}f}", value, precision));
}

from_chars_result from_chars(const char* first, const char* last, double& value) {
    return parse(first, last, value, strtod);
}
from_chars_result from_chars(const char* first, const char* last, float& value) {
    return parse(first, last, value, strtof);
}

}  // namespace std
