// Which reader a file goes to: by what it begins with, then by its extension.
#include <algorithm>
#include <array>
#include <bit>

#include "io/file.h"
#include "io/formats.h"
#include "io/rows.h"
#include "io/types.h"

namespace gaussmap {

namespace io {

void fail(const Source& source, const std::string& where, const std::string& what, const std::string& advice) {
    std::string message = source.name + ": ";
    if (!where.empty()) message += where + ": ";
    message += what;
    if (!advice.empty()) message += "; " + advice;
    throw FormatError(message);
}

namespace {

/// What begins the files of programs near to ours, and how to come by their contents.
struct Foreign {
    std::string_view magic;
    const char* what;
    const char* advice;
};
constexpr const char* convert_it = "convert it to one of ";
constexpr std::array<Foreign, 12> foreign = {
    {{"LASF", "a LAS or LAZ file", convert_it},
     {"ASTM-E57", "an E57 file", convert_it},
     {"DRACO", "a Draco file", convert_it},
     {std::string_view("II*\0", 4), "a TIFF picture", convert_it},
     {std::string_view("MM\0*", 4), "a TIFF picture", convert_it},
     {"\x89PNG", "a PNG picture", convert_it},
     {"glTF", "a glTF file", convert_it},
     {"Kaydara FBX Binary", "an FBX file", convert_it},
     {"PK\x03\x04", "a zip archive", "unpack it, or convert it to one of "},
     {"\x1F\x8B", "a file compressed by gzip", "unpack it, or convert it to one of "},
     {"# vtk DataFile", "a VTK file", convert_it},
     {"<?xml", "an XML file", convert_it}}};

/// OFF with its prefixes: [ST][C][N][4][n]OFF.
bool is_off_word(std::string_view word) {
    for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
        if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
    }
    return word == "OFF";
}

bool is_obj_word(std::string_view word) {
    constexpr std::array<std::string_view, 12> words = {"v", "vt", "vn", "vp",     "f",      "l",
                                                        "p", "g",  "o",  "mtllib", "usemtl", "s"};
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// 80 bytes of anything, a count, and 50 bytes a facet.
bool is_binary_stl(std::string_view bytes) {
    if (bytes.size() <= 84) return false;
    auto count = value_at<std::uint32_t>(bytes.data() + 80);
    if constexpr (std::endian::native == std::endian::big) count = swapped(count);
    return bytes.size() == 84 + 50 * std::size_t{count};
}

/// The first line that is neither blank nor a comment.
std::string_view first_line(std::string_view text) {
    Lines lines(text);
    std::string_view line;
    while (lines.next(line)) {
        std::string_view rest = line;
        const std::string_view word = next_word(rest);
        if (!word.empty() && word[0] != '#' && !word.starts_with("//")) return line;
    }
    return {};
}

/// The format that the content alone makes certain.
Format format_by_content(std::string_view bytes) {
    if (is_binary_stl(bytes)) return Format::stl;
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    if (bytes.starts_with("ply") && bytes.size() > 3 && is_blank(bytes[3])) return Format::ply;
    if (bytes.starts_with("# .PCD")) return Format::pcd;
    std::string_view line = first_line(bytes);
    const std::string_view word = next_word(line);
    if (word == "VERSION" || word == "FIELDS") return Format::pcd;
    if (is_off_word(word)) return Format::off;
    if (word == "solid" && (bytes.find("facet") != bytes.npos || bytes.find("endsolid") != bytes.npos))
        return Format::stl;
    if (is_obj_word(word)) return Format::obj;
    return Format::detect;
}

/// Rows of numbers are points, unless the extension knows better.
bool begins_with_numbers(std::string_view bytes) {
    std::string_view line = first_line(bytes);
    double value = 0;
    std::string_view word = next_word(line);
    word = word.substr(0, word.find_first_of(",;"));
    return !word.empty() && parse(word, value);
}

Format detect(const Source& source) {
    const Format certain = format_by_content(source.bytes);
    if (certain != Format::detect) return certain;
    for (const auto& [magic, what, advice] : foreign) {
        if (source.bytes.starts_with(magic))
            fail(source, "", std::string(what) + ", which is not read", advice + known_extensions());
    }
    const Format by_name = format_of(source.name);
    if (by_name != Format::detect) return by_name;
    if (begins_with_numbers(source.bytes)) return Format::xyz;
    fail(source, "", "the format is not known", convert_it + known_extensions());
}

/// No text at all behind the name of a text format.
void check_text(const Source& source) {
    text_of(source);  // tells UTF-16, which is full of zero bytes
    const std::size_t at = source.bytes.substr(0, 4096).find('\0');
    if (at == std::string_view::npos) return;
    fail(source, "byte " + std::to_string(at + 1), "a zero byte, so this is no text",
         "give a text file in UTF-8, or the format that it is of");
}

Geometry read_as(Format format, const Source& source) {
    switch (format) {
        case Format::ply:
            return read_ply(source);
        case Format::obj:
            check_text(source);
            return read_obj(source);
        case Format::off:
            return read_off(source);
        case Format::stl:
            return read_stl(source);
        case Format::pcd:
            return read_pcd(source);
        default:
            check_text(source);
            return read_xyz(source);
    }
}

}  // namespace

}  // namespace io

Geometry read_bytes(std::string_view bytes, const std::string& name, Format format, const Execution& run) {
    const io::Source source{bytes, name, run};
    if (bytes.empty()) io::fail(source, "", "the file is empty (0 bytes)", "write it anew");
    if (format == Format::detect) format = io::detect(source);
    Geometry geometry = io::read_as(format, source);
    geometry.format = format;
    return geometry;
}

Geometry read(const std::string& path, Format format, const Execution& run) {
    const io::FileBytes file(path);
    return read_bytes(file.bytes(), path, format, run);
}

}  // namespace gaussmap
