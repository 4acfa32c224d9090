// JSON, written: as much of it as the head of a page needs.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.h"

namespace gaussmap {

/// A string of JSON that may stand in an HTML script: < is escaped too. Bytes beyond ASCII are taken to be UTF-8.
inline std::string json_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20 || c == '<') {
            char escaped[8];
            std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(c));
            out += escaped;
        } else {
            out += c;
        }
    }
    return out + '"';
}

/// Shortest digits that give the number back; null for what is not finite.
inline std::string json_number(double value) {
    return std::isfinite(value) ? shown(value) : "null";
}

inline std::string json_list(const std::vector<std::string>& items) {
    std::string out = "[";
    for (const std::string& item : items) out.append(out.size() > 1 ? "," : "").append(item);
    return out + "]";
}

}  // namespace gaussmap
