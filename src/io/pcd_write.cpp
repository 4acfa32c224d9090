// PCD v0.7, as records or as text.
#include <array>
#include <bit>
#include <optional>

#include "io/colors.h"
#include "io/text.h"
#include "io/types.h"

namespace gaussmap::io {

namespace {

static_assert(std::endian::native == std::endian::little,
              "binary PCD is little-endian, as is every machine we build for");

/// What is written of every point: `count` values of `type`, those of point i at bytes[i · count · size_of(type)].
struct Column {
    std::string name;
    Type type = Type::float32;
    std::size_t count = 1;
    std::vector<std::byte> bytes;

    std::size_t size() const { return count * size_of(type); }
};

void add_triples(std::vector<Column>& columns, const std::array<const char*, 3>& names, const std::vector<double>& xyz,
                 Type type) {
    const Type written = type == Type::float32 ? Type::float32 : Type::float64;
    std::vector<double> axis(xyz.size() / 3);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < axis.size(); ++i) axis[i] = xyz[3 * i + c];
        columns.push_back({names[c], written, 1, make_property("", axis, written).bytes});
    }
}

/// Colours are packed as 0xAARRGGBB. PCL wants the bits of `rgb` in a float, except in text, and of `rgba` in an
/// integer.
Column pack_colors(const std::vector<const Property*>& colors, std::size_t points, bool ascii) {
    const bool alpha = colors.size() == 4;
    Column column{alpha ? "rgba" : "rgb", alpha || ascii ? Type::uint32 : Type::float32, 1, {}};
    column.bytes.resize(4 * points);
    for (std::size_t i = 0; i < points; ++i) {
        for (std::size_t c = 0; c < 3; ++c) column.bytes[4 * i + 2 - c] = colors[c]->bytes[i];
        column.bytes[4 * i + 3] = alpha ? colors[3]->bytes[i] : std::byte{0};
    }
    return column;
}

/// The number of values in every list of a property; nothing where they differ, or are none.
std::optional<std::size_t> uniform_length(const Property& property) {
    if (!property.list) return 1;
    if (property.offsets.size() < 2) return std::nullopt;
    const std::uint64_t length = property.offsets[1] - property.offsets[0];
    for (std::size_t i = 1; i < property.offsets.size(); ++i) {
        if (property.offsets[i] - property.offsets[i - 1] != length) return std::nullopt;
    }
    return length == 0 ? std::nullopt : std::optional<std::size_t>(length);
}

std::vector<Column> columns_of(const Geometry& geometry, bool ascii) {
    std::vector<Column> columns;
    add_triples(columns, {"x", "y", "z"}, geometry.vertices, geometry.vertex_type);
    if (!geometry.normals.empty()) {
        add_triples(columns, {"normal_x", "normal_y", "normal_z"}, geometry.normals, geometry.normal_type);
    }
    const std::vector<const Property*> colors = find_colors(geometry.vertex_properties);
    if (!colors.empty()) columns.push_back(pack_colors(colors, geometry.vertex_count(), ascii));
    for (const Property& p : geometry.vertex_properties) {
        const std::optional<std::size_t> length = uniform_length(p);
        if (!length || std::find(colors.begin(), colors.end(), &p) != colors.end()) continue;
        std::string name = p.name;
        std::replace_if(name.begin(), name.end(), is_blank, '_');
        const std::size_t first = p.list ? p.offsets.front() * size_of(p.type) : 0;
        const auto begin = p.bytes.begin() + static_cast<std::ptrdiff_t>(first);
        const std::size_t bytes = geometry.vertex_count() * *length * size_of(p.type);
        columns.push_back({name, p.type, *length, {begin, begin + static_cast<std::ptrdiff_t>(bytes)}});
    }
    return columns;
}

std::string header_of(const Geometry& geometry, const std::vector<Column>& columns, bool ascii) {
    std::string fields = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
    for (const Column& c : columns) {
        const bool is_signed =
            c.type == Type::int8 || c.type == Type::int16 || c.type == Type::int32 || c.type == Type::int64;
        fields.append(" ").append(c.name);
        sizes.append(" ").append(std::to_string(size_of(c.type)));
        types.append(is_float(c.type) ? " F" : is_signed ? " I" : " U");
        counts.append(" ").append(std::to_string(c.count));
    }
    const std::size_t points = geometry.vertex_count();
    const bool organised = geometry.width > 0 && points % geometry.width == 0;
    const std::size_t width = organised ? geometry.width : points;
    const std::size_t height = organised ? points / geometry.width : 1;
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "\n" + sizes + "\n" + types + "\n" +
           counts + "\nWIDTH " + std::to_string(width) + "\nHEIGHT " + std::to_string(height) +
           "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " + (ascii ? "ascii" : "binary") +
           "\n";
}

void append_text(std::string& out, const Column& column, std::size_t point) {
    with_type(column.type, [&](auto zero) {
        using T = decltype(zero);
        for (std::size_t c = 0; c < column.count; ++c) {
            const T value = value_at<T>(column.bytes.data() + (point * column.count + c) * sizeof(T));
            if constexpr (std::is_floating_point_v<T>)
                append_number(out, value, column.type);
            else
                out += std::to_string(value);
            out += ' ';
        }
    });
}

}  // namespace

std::string write_pcd(const Geometry& geometry, const WriteOptions& options) {
    const std::vector<Column> columns = columns_of(geometry, options.ascii);
    std::string out = header_of(geometry, columns, options.ascii);
    for (std::size_t i = 0; i < geometry.vertex_count(); ++i) {
        for (const Column& c : columns) {
            if (options.ascii)
                append_text(out, c, i);
            else
                out.append(reinterpret_cast<const char*>(c.bytes.data() + i * c.size()), c.size());
        }
        if (options.ascii) out.back() = '\n';
    }
    return out;
}

}  // namespace gaussmap::io
