// The header of a PLY file (Turk 1994): it names elements and their properties, in the order of the body.
#pragma once

#include <array>
#include <bit>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/formats.h"
#include "io/rows.h"
#include "io/types.h"

namespace gaussmap::io::ply {

inline constexpr const char* mend = "mend the file or write it anew";

/// Types by the names of the first PLY files, then by those of later ones.
inline constexpr std::array<std::pair<std::string_view, Type>, 18> type_names = {{{"char", Type::int8},
                                                                                  {"uchar", Type::uint8},
                                                                                  {"short", Type::int16},
                                                                                  {"ushort", Type::uint16},
                                                                                  {"int", Type::int32},
                                                                                  {"uint", Type::uint32},
                                                                                  {"int64", Type::int64},
                                                                                  {"uint64", Type::uint64},
                                                                                  {"float", Type::float32},
                                                                                  {"double", Type::float64},
                                                                                  {"int8", Type::int8},
                                                                                  {"uint8", Type::uint8},
                                                                                  {"int16", Type::int16},
                                                                                  {"uint16", Type::uint16},
                                                                                  {"int32", Type::int32},
                                                                                  {"uint32", Type::uint32},
                                                                                  {"float32", Type::float32},
                                                                                  {"float64", Type::float64}}};

/// One property and where its values are: after reading in the property itself, or, where all records of an element
/// have the same size, still in the file.
struct Column {
    Property property;
    const char* first = nullptr;  // the value of item 0 in the file; null: the values are in the property
    std::size_t stride = 0;       // bytes from one item to the next
    std::size_t length = 1;       // values an item
    bool taken = false;           // as coordinates, say, so no longer one of the other properties
};

struct Table {
    std::string name;
    std::size_t count = 0;
    std::vector<Column> columns;
};

struct Header {
    bool ascii = false;
    bool swap = false;  // binary in the other byte order than this machine's
    std::vector<Table> elements;
    std::vector<std::string> comments;
    std::string_view body;
};

/// The name of a type that every reader of PLY knows.
inline std::string_view type_name(Type type) {
    for (const auto& [name, its_type] : type_names) {
        if (its_type == type) return name;
    }
    return {};
}

inline bool find_type(std::string_view name, Type& type) {
    for (const auto& [known, its_type] : type_names) {
        if (name == known) return type = its_type, true;
    }
    return false;
}

inline void read_format(const Source& source, const Lines& lines, std::string_view rest, Header& header) {
    const std::string_view word = next_word(rest);
    constexpr bool little = std::endian::native == std::endian::little;
    if (word == "ascii") {
        header.ascii = true;
    } else if (word == "binary_little_endian" || word == "binary_big_endian") {
        header.swap = (word == "binary_little_endian") != little;
    } else {
        fail(source, lines.where(),
             "format " + quoted(word) + " is not ascii, binary_little_endian or binary_big_endian", mend);
    }
}

inline void add_element(const Source& source, const Lines& lines, std::string_view rest, Header& header) {
    Table element;
    element.name = next_word(rest);
    std::int64_t count = 0;
    const std::string_view word = next_word(rest);
    if (element.name.empty() || !parse(word, count) || count < 0) {
        fail(source, lines.where(), "element " + quoted(element.name) + " with the count " + quoted(word), mend);
    }
    for (const Table& other : header.elements) {
        if (other.name == element.name) fail(source, lines.where(), "a second element " + quoted(element.name), mend);
    }
    element.count = static_cast<std::size_t>(count);
    header.elements.push_back(std::move(element));
}

inline void add_property(const Source& source, const Lines& lines, std::string_view rest, Header& header) {
    if (header.elements.empty()) fail(source, lines.where(), "a property before any element", mend);
    Property property;
    std::string_view word = next_word(rest);
    property.list = word == "list";
    if (property.list) {
        word = next_word(rest);
        if (!find_type(word, property.count_type) || is_float(property.count_type)) {
            fail(source, lines.where(), quoted(word) + " is no type for the length of a list", mend);
        }
        word = next_word(rest);
    }
    if (!find_type(word, property.type)) fail(source, lines.where(), quoted(word) + " is no type", mend);
    property.name = next_word(rest);
    if (property.name.empty()) fail(source, lines.where(), "a property without a name", mend);
    header.elements.back().columns.push_back({.property = std::move(property)});
}

inline std::string_view without_leading_blanks(std::string_view text) {
    while (!text.empty() && is_blank(text[0])) text.remove_prefix(1);
    return text;
}

/// The body begins right behind the end of the last header line. Where all lines end in \r alone, an \n there is data.
inline std::string_view body_of(const Source& source, const Lines& lines) {
    std::size_t begin = source.bytes.size() - lines.rest().size();
    const std::size_t first_end = source.bytes.find_first_of("\r\n");
    const bool lone_cr = source.bytes[first_end] == '\r' && source.bytes[first_end + 1] != '\n';
    if (lone_cr && source.bytes[begin - 1] == '\n') --begin;
    return source.bytes.substr(begin);
}

inline Header read_header(const Source& source) {
    Header header;
    Lines lines(source.bytes);
    std::string_view line;
    if (!lines.next(line) || next_word(line) != "ply")
        fail(source, "line 1", "a PLY file begins with the word ply", mend);
    bool has_format = false;
    while (lines.next(line)) {
        std::string_view rest = line;
        const std::string_view word = next_word(rest);
        if (word == "end_header") {
            if (!has_format) fail(source, lines.where(), "the header has no format line", mend);
            header.body = body_of(source, lines);
            return header;
        }
        if (word == "format") {
            read_format(source, lines, rest, header);
            has_format = true;
        } else if (word == "comment") {
            header.comments.emplace_back(without_leading_blanks(rest));
        } else if (word == "obj_info") {
            header.comments.push_back("obj_info " + std::string(without_leading_blanks(rest)));
        } else if (word == "element") {
            add_element(source, lines, rest, header);
        } else if (word == "property") {
            add_property(source, lines, rest, header);
        } else if (!word.empty()) {
            fail(source, lines.where(), quoted(word) + " is no keyword of a PLY header", mend);
        }
    }
    fail(source, lines.where(), "the header has no end_header", mend);
}

}  // namespace gaussmap::io::ply
