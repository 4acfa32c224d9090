// What the readers of text formats share: the text itself, words that must be numbers, progress.
#pragma once

#include <cctype>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "io/text.h"

namespace gaussmap::io {

/// The text of a file without its byte order mark. UTF-16 is a FormatError.
inline std::string_view text_of(const Source& source) {
    std::string_view text = source.bytes;
    if (text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE")) {
        fail(source, "", "the text is UTF-16", "save it as UTF-8");
    }
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

/// A word as messages show it: in quotes, cut to 24 characters, unprintable ones as '?'.
inline std::string quoted(std::string_view word) {
    std::string out = "\"";
    for (const char c : word.substr(0, 24)) out += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
    return out + (word.size() > 24 ? "…\"" : "\"");
}

inline std::string lower(std::string_view word) {
    std::string out(word);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

/// "1 face", "2 faces".
inline std::string counted(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// The word as a number, or a FormatError with the line.
inline double number(const Source& source, const Lines& lines, std::string_view word) {
    double value = 0;
    if (!parse(word, value)) fail(source, lines.where(), quoted(word) + " is no number");
    return value;
}

/// The word as an index or a count that fits 32 bits, or a FormatError with the line.
inline std::int32_t index(const Source& source, const Lines& lines, std::string_view word) {
    std::int64_t value = 0;
    if (!parse(word, value) || value < 0 || value > std::numeric_limits<std::int32_t>::max()) {
        fail(source, lines.where(), quoted(word) + " is no whole number from 0 to 2147483647");
    }
    return static_cast<std::int32_t>(value);
}

/// Tell how far reading has come, now and then.
inline void report(const Source& source, const Lines& lines) {
    if (lines.number() % 65536 != 0 || !source.run.progress) return;
    const double left = static_cast<double>(lines.rest().size()) / static_cast<double>(source.bytes.size());
    if (!source.run.progress(1 - left)) throw Cancelled();
}

}  // namespace gaussmap::io
