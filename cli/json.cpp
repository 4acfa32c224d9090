#include "json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cli {
namespace {

/// Bytes of the character of UTF-8 that a text begins with: no overlong form, no surrogate, at most U+10FFFF (RFC 3629,
/// section 4). 0 where it begins with none.
std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned lead = byte(0);
    if (lead < 0x80) return 1;
    if (lead < 0xc2 || lead > 0xf4) return 0;
    const unsigned least = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
    const unsigned most = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
    if (byte(1) < least || byte(1) > most) return 0;
    const std::size_t length = lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    for (std::size_t i = 2; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    return length;
}

void write_string(std::string& out, std::string_view text) {
    out += '"';
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        const char c = text.front();
        if (length == 0)
            out += "\ufffd";
        else if (c == '"' || c == '\\')
            out += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out += text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    out += '"';
}

/// The shortest text that reads back as the number, with a point or an exponent: 1.0, 0.25, 1e-07.
void write_number(std::string& out, double value) {
    if (!std::isfinite(value)) {
        out += "null";
        return;
    }
    const std::string digits = fmt::format("{}", value);
    out += digits;
    if (digits.find_first_of(".e") == std::string::npos) out += ".0";
}

}  // namespace

Json::Json(std::initializer_list<Member> members) : value_(Object(members)) {}
Json::~Json() = default;
Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(const Json&) = default;
Json& Json::operator=(Json&&) noexcept = default;

Json Json::array() {
    Json out;
    out.value_ = Array();
    return out;
}

Json Json::object() {
    Json out;
    out.value_ = Object();
    return out;
}

bool Json::is_number() const {
    return std::holds_alternative<std::int64_t>(value_) || std::holds_alternative<double>(value_);
}

template <class Value>
Value Json::get() const {
    if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
        if (const auto* whole = std::get_if<std::int64_t>(&value_)) return static_cast<Value>(*whole);
        if (const auto* real = std::get_if<double>(&value_)) return static_cast<Value>(*real);
    } else {
        if (const auto* value = std::get_if<Value>(&value_)) return *value;
    }
    throw std::logic_error("a value of a report is of another kind than was asked for");
}
template std::string Json::get() const;
template bool Json::get() const;
template int Json::get() const;
template std::size_t Json::get() const;
template double Json::get() const;

const std::vector<Json::Member>& Json::items() const {
    if (const auto* members = std::get_if<Object>(&value_)) return *members;
    throw std::logic_error("a value of a report is no object");
}

const Json* Json::find(std::string_view name) const {
    const Object& members = items();
    const auto found = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.first == name; });
    return found == members.end() ? nullptr : &found->second;
}

const Json& Json::operator[](std::string_view name) const {
    if (const Json* const found = find(name)) return *found;
    throw std::logic_error("a report has no '" + std::string(name) + "'");
}

Json& Json::operator[](std::string_view name) {
    if (is_null()) value_ = Object();
    if (const Json* const found = find(name)) return const_cast<Json&>(*found);
    return std::get<Object>(value_).emplace_back(std::string(name), Json()).second;
}

void Json::update(const Json& other) {
    for (const auto& [name, value] : other.items()) (*this)[name] = value;
}

const Json::Array& Json::elements() const {
    if (const auto* values = std::get_if<Array>(&value_)) return *values;
    throw std::logic_error("a value of a report is no array");
}

void Json::push_back(Json value) {
    if (is_null()) value_ = Array();
    elements();
    std::get<Array>(value_).push_back(std::move(value));
}

std::string Json::dump() const {
    std::string out;
    write(out, 0);
    return out;
}

void Json::write(std::string& out, std::size_t depth) const {
    const std::string line = "\n" + std::string(2 * depth, ' ');
    if (const auto* flag = std::get_if<bool>(&value_)) {
        out += *flag ? "true" : "false";
    } else if (const auto* whole = std::get_if<std::int64_t>(&value_)) {
        out += std::to_string(*whole);
    } else if (const auto* real = std::get_if<double>(&value_)) {
        write_number(out, *real);
    } else if (const auto* text = std::get_if<std::string>(&value_)) {
        write_string(out, *text);
    } else if (const auto* values = std::get_if<Array>(&value_)) {
        out += '[';
        for (const Json& value : *values) {
            out += (&value == values->data() ? "" : ",") + line + "  ";
            value.write(out, depth + 1);
        }
        out += (values->empty() ? "" : line) + "]";
    } else if (const auto* members = std::get_if<Object>(&value_)) {
        out += '{';
        for (const Member& member : *members) {
            out += (&member == members->data() ? "" : ",") + line + "  ";
            write_string(out, member.first);
            out += ": ";
            member.second.write(out, depth + 1);
        }
        out += (members->empty() ? "" : line) + "}";
    } else {
        out += "null";
    }
}

}  // namespace cli
