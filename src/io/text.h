// Scanning numbers and words of text files, with the line number at hand for messages.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/formats.h"

namespace gaussmap::io {

/// Walks over text line by line; lines end in \n, \r\n or \r.
class Lines {
  public:
    explicit Lines(std::string_view text) : rest_(text) {}

    /// The next line without its end; false where the text is used up.
    bool next(std::string_view& line) {
        if (rest_.empty()) return false;
        std::size_t end = 0;
        while (end < rest_.size() && rest_[end] != '\n' && rest_[end] != '\r') ++end;
        line = rest_.substr(0, end);
        if (end == rest_.size()) {
            rest_ = {};
        } else {
            const bool pair = rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
            rest_.remove_prefix(end + (pair ? 2 : 1));
        }
        ++number_;
        return true;
    }
    /// Number of the line last given, from 1.
    std::size_t number() const { return number_; }
    std::string where() const { return "line " + std::to_string(number_); }
    std::string_view rest() const { return rest_; }

  private:
    std::string_view rest_;
    std::size_t number_ = 0;
};

inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r' || c == '\n';
}

/// Cut the next word off the front of `text`, blanks skipped; empty where there is none.
inline std::string_view next_word(std::string_view& text) {
    std::size_t begin = 0;
    while (begin < text.size() && is_blank(text[begin])) ++begin;
    std::size_t end = begin;
    while (end < text.size() && !is_blank(text[end])) ++end;
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

/// The whole word as a number: "1e-3", "+2", "nan", "inf", "-INF"; false otherwise. Values beyond double become ±inf or
/// 0.
bool parse(std::string_view word, double& value);
/// The whole word as an integer; false otherwise, or out of range.
bool parse(std::string_view word, std::int64_t& value);

/// Shortest text that reads back to the same value (to the same float32 where the type is float32).
void append_number(std::string& out, double value, Type type = Type::float64);

}  // namespace gaussmap::io
