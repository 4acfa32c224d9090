// PCD v.5 to .7, the Point Cloud Library's format: as text, as records, and as columns compressed by LZF.
#include <array>
#include <bit>
#include <optional>
#include <set>
#include <span>

#include "io/colors.h"
#include "io/rows.h"
#include "io/types.h"

#ifdef GAUSSMAP_LZF
#include <lzf.h>
#endif

namespace gaussmap::io {

namespace {

static_assert(std::endian::native == std::endian::little,
              "binary PCD is little-endian and so is every machine we build for");

constexpr std::uint64_t most_points = std::numeric_limits<std::int32_t>::max();

struct Field {
    std::string name;
    Type type = Type::float32;
    std::size_t count = 1;  // values a point

    std::size_t size() const { return count * size_of(type); }
};

struct Header {
    std::vector<Field> fields;
    std::uint64_t width = 0, height = 1, points = 0;
    std::string data;  // ascii, binary or binary_compressed

    bool has(std::string_view name) const {
        return std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
    }
    /// Bytes of one point.
    std::size_t record() const {
        std::size_t bytes = 0;
        for (const Field& f : fields) bytes += f.size();
        return bytes;
    }
};

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    for (auto word = next_word(text); !word.empty(); word = next_word(text)) words.emplace_back(word);
    return words;
}

/// TYPE I, U or F and SIZE 1, 2, 4 or 8.
std::optional<Type> type_of(std::string_view type, std::int32_t size) {
    struct Row {
        std::string_view type;
        std::int32_t size;
        Type meant;
    };
    static constexpr std::array<Row, 10> rows = {{{"I", 1, Type::int8},
                                                  {"U", 1, Type::uint8},
                                                  {"I", 2, Type::int16},
                                                  {"U", 2, Type::uint16},
                                                  {"I", 4, Type::int32},
                                                  {"U", 4, Type::uint32},
                                                  {"I", 8, Type::int64},
                                                  {"U", 8, Type::uint64},
                                                  {"F", 4, Type::float32},
                                                  {"F", 8, Type::float64}}};
    for (const Row& row : rows) {
        if (row.type == type && row.size == size) return row.meant;
    }
    return std::nullopt;
}

/// Reads the lines up to DATA; what follows them is `lines.rest()`.
class HeaderReader {
  public:
    HeaderReader(const Source& source, Lines& lines) : source_(source), lines_(lines) {}

    Header read() {
        std::string_view line;
        while (header_.data.empty()) {
            if (!lines_.next(line))
                fail(source_, "", "the PCD header has no DATA line", "the file is cut short, or no PCD");
            const std::string_view keyword = next_word(line);
            if (!keyword.empty() && keyword[0] != '#') take(keyword, words_of(line));
        }
        build_fields();
        check_points();
        return std::move(header_);
    }

  private:
    void take(std::string_view keyword, std::vector<std::string>&& words) {
        if (keyword == "FIELDS" || keyword == "COLUMNS")
            names_ = std::move(words);
        else if (keyword == "SIZE")
            sizes_ = std::move(words);
        else if (keyword == "TYPE")
            types_ = std::move(words);
        else if (keyword == "COUNT")
            counts_ = std::move(words);
        else if (keyword == "WIDTH")
            header_.width = count_of(words);
        else if (keyword == "HEIGHT")
            header_.height = count_of(words);
        else if (keyword == "POINTS")
            points_ = count_of(words);
        else if (keyword == "DATA")
            header_.data = words.empty() ? "nothing" : lower(words[0]);
        else if (keyword != "VERSION" && keyword != "VIEWPOINT") {
            fail(source_, lines_.where(), quoted(keyword) + " is no word of a PCD header, which ends with DATA",
                 "the header is missing or broken");
        }
    }

    std::uint64_t count_of(const std::vector<std::string>& words) const {
        return static_cast<std::uint64_t>(index(source_, lines_, words.empty() ? "" : words[0]));
    }

    void build_fields() {
        if (counts_.empty()) counts_.assign(names_.size(), "1");
        if (names_.empty()) fail(source_, "header", "no FIELDS");
        for (const auto* list : {&sizes_, &types_, &counts_}) {
            if (list->size() == names_.size()) continue;
            const std::string what = list == &sizes_ ? "SIZE" : list == &types_ ? "TYPE" : "COUNT";
            fail(source_, "header",
                 what + " has " + std::to_string(list->size()) + " entries for " + counted(names_.size(), "field"));
        }
        std::set<std::string> seen;
        for (std::size_t i = 0; i < names_.size(); ++i) {
            const std::optional<Type> type = type_of(types_[i], index(source_, lines_, sizes_[i]));
            if (!type) {
                fail(source_, "header",
                     "field " + names_[i] + " has TYPE " + quoted(types_[i]) + " and SIZE " + quoted(sizes_[i]) +
                         ", which PCD does not know");
            }
            const std::int32_t count = index(source_, lines_, counts_[i]);
            const bool coordinate = names_[i] == "x" || names_[i] == "y" || names_[i] == "z";
            if (count == 0 || (coordinate && count > 1)) {
                fail(source_, "header", "field " + names_[i] + " has COUNT " + counts_[i]);
            }
            if (names_[i] != "_" && !seen.insert(names_[i]).second) {
                fail(source_, "header", "field " + names_[i] + " is there twice");
            }
            header_.fields.push_back({names_[i], *type, static_cast<std::size_t>(count)});
        }
        for (const char* name : {"x", "y", "z"}) {
            if (!seen.contains(name))
                fail(source_, "header", std::string("no field ") + name, "a cloud needs x, y and z");
        }
    }

    void check_points() {
        const std::uint64_t product = header_.width * header_.height;  // of two 31-bit numbers
        header_.points = points_.value_or(product);
        if (product != header_.points) {
            fail(source_, "header",
                 "WIDTH " + std::to_string(header_.width) + " times HEIGHT " + std::to_string(header_.height) +
                     " is not POINTS " + std::to_string(header_.points));
        }
        if (header_.points > most_points) fail(source_, "header", "more than 2147483647 points");
    }

    const Source& source_;
    Lines& lines_;
    Header header_;
    std::optional<std::uint64_t> points_;
    std::vector<std::string> names_, sizes_, types_, counts_;
};

/// The values of every field, one after the other, in the types of the header.
using Columns = std::vector<std::vector<std::byte>>;

[[noreturn]] void cut_short(const Source& source, std::uint64_t there, std::uint64_t claimed) {
    fail(source, "", "the file ends after " + std::to_string(there) + " of " + std::to_string(claimed) + " points",
         "it is cut short");
}

Columns make_columns(const Header& header) {
    Columns columns;
    for (const Field& field : header.fields) columns.emplace_back(field.size() * header.points);
    return columns;
}

Columns read_binary(const Source& source, const Header& header, std::string_view data, Geometry& geometry) {
    const std::size_t record = header.record();
    if (data.size() / record < header.points) cut_short(source, data.size() / record, header.points);
    if (const std::size_t rest = data.size() - record * header.points; rest > 0) {
        geometry.notes.push_back(counted(rest, "byte") + " after the last point ignored");
    }
    Columns columns = make_columns(header);
    std::size_t offset = 0;
    for (std::size_t f = 0; f < columns.size(); ++f) {
        const std::size_t size = header.fields[f].size();
        for (std::size_t i = 0; i < header.points; ++i) {
            std::memcpy(columns[f].data() + i * size, data.data() + i * record + offset, size);
        }
        offset += size;
    }
    return columns;
}

#ifdef GAUSSMAP_LZF
Columns read_compressed(const Source& source, const Header& header, std::string_view data) {
    if (data.size() < 8) cut_short(source, 0, header.points);
    const auto packed = value_at<std::uint32_t>(data.data()), unpacked = value_at<std::uint32_t>(data.data() + 4);
    data.remove_prefix(8);
    if (packed > data.size()) {
        fail(source, "",
             "the compressed points claim " + std::to_string(packed) + " bytes, but only " +
                 std::to_string(data.size()) + " follow",
             "the file is cut short");
    }
    // Three bytes of LZF make at most 264 (LibLZF's longest match), so a larger claim is a lie.
    const std::size_t record = header.record();
    if (record == 0 || unpacked / record != header.points || unpacked % record != 0 || unpacked / 88 > packed) {
        fail(source, "",
             "the compressed points claim " + std::to_string(unpacked) + " bytes unpacked, but " +
                 std::to_string(header.points) + " points of " + std::to_string(record) + " bytes in " +
                 std::to_string(packed) + " are not that",
             "the file is damaged");
    }
    std::vector<std::byte> bytes(unpacked);
    if (unpacked > 0 && lzf_decompress(data.data(), packed, bytes.data(), unpacked) != unpacked) {
        fail(source, "", "the compressed points cannot be unpacked", "the file is damaged");
    }
    Columns columns;
    std::size_t begin = 0;
    for (const Field& field : header.fields) {
        const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(begin);
        columns.emplace_back(from, from + static_cast<std::ptrdiff_t>(field.size() * header.points));
        begin += field.size() * header.points;
    }
    return columns;
}
#else
Columns read_compressed(const Source& source, const Header&, std::string_view) {
    fail(source, "", "this build reads no binary_compressed PCD (it lacks liblzf)",
         "write the file as binary or ascii");
}
#endif

/// A word as a value of any type, exactly; false where the type does not hold it.
bool store(std::string_view word, Type type, std::byte* to) {
    return with_type(type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_floating_point_v<T>) {
            double value = 0;
            if (!parse(word, value)) return false;
            put(to, static_cast<T>(value));
        } else {
            T value = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (error != std::errc() || end != word.data() + word.size()) return false;
            put(to, value);
        }
        return true;
    });
}

Columns read_ascii(const Source& source, const Header& header, Lines& lines, Geometry& geometry) {
    std::size_t values = 0;
    for (const Field& field : header.fields) values += field.count;
    // Every value takes a character and a separator.
    const std::size_t most = values == 0 ? 0 : (lines.rest().size() + 1) / 2 / values;
    if (most < header.points) {
        fail(source, "header",
             std::to_string(header.points) + " points are claimed, but only " + counted(lines.rest().size(), "byte") +
                 " follow",
             "the file is cut short");
    }
    Columns columns = make_columns(header);
    std::string_view line;
    std::size_t point = 0;
    for (; lines.next(line);) {
        report(source, lines);
        auto word = next_word(line);
        if (word.empty() || word[0] == '#') continue;
        if (point == header.points) {
            geometry.notes.push_back("text after the last point ignored (" + lines.where() + ")");
            break;
        }
        for (std::size_t f = 0; f < columns.size(); ++f) {
            const Field& field = header.fields[f];
            for (std::size_t c = 0; c < field.count; ++c, word = next_word(line)) {
                if (word.empty())
                    fail(source, lines.where(), "fewer than the " + counted(values, "value") + " of a point");
                std::byte* const to = columns[f].data() + (point * field.count + c) * size_of(field.type);
                if (!store(word, field.type, to)) {
                    fail(source, lines.where(), quoted(word) + " is no value for field " + field.name);
                }
            }
        }
        if (!word.empty()) fail(source, lines.where(), "more than the " + counted(values, "value") + " of a point");
        ++point;
    }
    if (point < header.points) cut_short(source, point, header.points);
    return columns;
}

/// Colours are packed as 0xAARRGGBB, in the bits of a float or an integer.
void unpack_colors(Geometry& geometry, const std::vector<std::byte>& packed, bool alpha) {
    const std::size_t points = packed.size() / 4;
    for (std::size_t channel = 0; channel < (alpha ? 4 : 3); ++channel) {
        Property property;
        property.name = color_names[channel];
        property.type = Type::uint8;
        property.bytes.resize(points);
        const std::size_t byte = channel == 3 ? 3 : 2 - channel;
        for (std::size_t i = 0; i < points; ++i) property.bytes[i] = packed[4 * i + byte];
        geometry.vertex_properties.push_back(std::move(property));
    }
}

Property as_property(const Field& field, std::vector<std::byte>&& bytes) {
    Property property;
    property.name = field.name;
    property.type = field.type;
    property.bytes = std::move(bytes);
    if (field.count > 1) {
        property.list = true;
        if (field.count > 255) property.count_type = Type::int32;
        for (std::size_t at = 0; at <= property.values(); at += field.count) property.offsets.push_back(at);
    }
    return property;
}

/// Coordinate or normal `axis` of every point; `kept` becomes wide enough for their type.
void spread(std::vector<double>& xyz, std::size_t axis, const Property& values, Type& kept) {
    xyz.resize(3 * values.values());
    for (std::size_t i = 0; i < values.values(); ++i) xyz[3 * i + axis] = values.at(i);
    const bool exact = values.type == Type::float32 || size_of(values.type) < 4;  // in float32
    if (!exact) kept = Type::float64;
}

/// Position of a field of one value among three names, else 3.
std::size_t axis_of(const Field& field, const std::array<std::string_view, 3>& names) {
    const auto found = std::find(names.begin(), names.end(), field.name);
    return field.count > 1 ? 3 : static_cast<std::size_t>(found - names.begin());
}

void take_columns(Geometry& geometry, const Header& header, Columns&& columns) {
    static constexpr std::array<std::string_view, 3> axes = {"x", "y", "z"};
    static constexpr std::array<std::string_view, 3> normal_axes = {"normal_x", "normal_y", "normal_z"};
    bool colors = header.has("red") || header.has("green") || header.has("blue") || header.has("alpha");
    std::size_t normals = 0;
    for (const Field& field : header.fields) normals += axis_of(field, normal_axes) < 3 ? 1 : 0;
    geometry.vertex_type = geometry.normal_type = Type::float32;
    for (std::size_t f = 0; f < columns.size(); ++f) {
        const Field& field = header.fields[f];
        if (field.name == "_") continue;  // padding
        const std::size_t axis = axis_of(field, axes), normal_axis = axis_of(field, normal_axes);
        const bool packed = (field.name == "rgb" || field.name == "rgba") && field.count == 1 && field.size() == 4;
        if (packed && !colors) {
            unpack_colors(geometry, columns[f], field.name == "rgba");
            colors = true;
            continue;
        }
        Property property = as_property(field, std::move(columns[f]));
        if (axis < 3)
            spread(geometry.vertices, axis, property, geometry.vertex_type);
        else if (normals == 3 && normal_axis < 3)
            spread(geometry.normals, normal_axis, property, geometry.normal_type);
        else
            geometry.vertex_properties.push_back(std::move(property));
    }
}

}  // namespace

Geometry read_pcd(const Source& source) {
    Geometry geometry;
    Lines lines(text_of(source));
    const Header header = HeaderReader(source, lines).read();
    Columns columns;
    if (header.data == "ascii")
        columns = read_ascii(source, header, lines, geometry);
    else if (header.data == "binary")
        columns = read_binary(source, header, lines.rest(), geometry);
    else if (header.data == "binary_compressed")
        columns = read_compressed(source, header, lines.rest());
    else
        fail(source, lines.where(), "DATA " + quoted(header.data) + " is not known",
             "it should be ascii, binary or binary_compressed");
    take_columns(geometry, header, std::move(columns));
    if (header.height > 1) geometry.width = header.width;
    return geometry;
}

}  // namespace gaussmap::io
