// PLY out: the vertices, the faces, then whatever other elements came with them.
#include <algorithm>
#include <array>
#include <limits>

#include "io/face_rows.h"
#include "io/formats.h"
#include "io/ply_header.h"
#include "io/text.h"
#include "io/types.h"

namespace gaussmap::io {

namespace {

/// One property of an element to write: where its values lie in memory, and as what they go into the file.
struct Column {
    std::string name;
    Type type = Type::float32;
    Type stored = type;  // in memory: type, or float64 for a type of float32
    const void* data = nullptr;
    std::size_t step = size_of(stored);  // bytes from one value to the next
    bool list = false;
    Type count_type = Type::uint8;
    const std::uint64_t* offsets = nullptr;  // of a list; null: every item has `length` values
    std::size_t length = 1;

    ValueRange values(std::size_t item) const {
        if (!offsets) return {item * length, (item + 1) * length};
        return {static_cast<std::size_t>(offsets[item]), static_cast<std::size_t>(offsets[item + 1])};
    }
    const char* at(std::size_t value) const { return static_cast<const char*>(data) + value * step; }
};

struct Table {
    std::string name;
    std::size_t items = 0;
    std::vector<Column> columns;
};

/// A word of the header: blanks become underscores.
std::string word(std::string name) {
    for (char& c : name) c = is_blank(c) ? '_' : c;
    return name.empty() ? "_" : name;
}

/// The type asked for, or the next one that can count to `length`.
Type wide_enough(Type count_type, std::size_t length) {
    for (const Type type : {count_type, Type::uint8, Type::uint16, Type::uint32, Type::uint64}) {
        const bool fits = !is_float(type) && with_type(type, [&](auto zero) {
            return length <= static_cast<std::uint64_t>(std::numeric_limits<decltype(zero)>::max());
        });
        if (fits) return type;
    }
    return Type::uint64;
}

Column column_of(const Property& p, std::size_t items) {
    Column column{.name = word(p.name), .type = p.type, .data = p.bytes.data(), .list = p.list};
    if (!p.list) return column;
    column.offsets = p.offsets.data();
    std::size_t longest = 0;
    for (std::size_t i = 0; i < items; ++i) longest = std::max<std::size_t>(longest, p.offsets[i + 1] - p.offsets[i]);
    column.count_type = wide_enough(p.count_type, longest);
    return column;
}

void add_triple(Table& table, const std::array<const char*, 3>& names, const std::vector<double>& values, Type type) {
    for (std::size_t c = 0; c < 3; ++c) {
        table.columns.push_back({.name = names[c],
                                 .type = is_float(type) ? type : Type::float64,
                                 .stored = Type::float64,
                                 .data = values.empty() ? nullptr : values.data() + c,
                                 .step = 3 * sizeof(double)});
    }
}

Table vertex_table(const Geometry& geometry) {
    Table table{"vertex", geometry.vertex_count(), {}};
    add_triple(table, {"x", "y", "z"}, geometry.vertices, geometry.vertex_type);
    if (!geometry.normals.empty()) add_triple(table, {"nx", "ny", "nz"}, geometry.normals, geometry.normal_type);
    for (const Property& p : geometry.vertex_properties) table.columns.push_back(column_of(p, table.items));
    return table;
}

Table face_table(const Geometry& geometry) {
    const FaceRows faces(geometry);
    Table table{"face", faces.count(), {}};
    Column indices{
        .name = "vertex_indices", .type = Type::int32, .data = geometry.faces.data(), .list = true, .length = 3};
    if (!geometry.polygons.empty()) {
        indices.data = geometry.polygons.corners.data();
        indices.offsets = geometry.polygons.offsets.data();
        std::size_t longest = 0;
        for (std::size_t f = 0; f < faces.count(); ++f) longest = std::max(longest, faces[f].size());
        indices.count_type = wide_enough(Type::uint8, longest);
    }
    table.columns.push_back(indices);
    for (const Property& p : geometry.face_properties) table.columns.push_back(column_of(p, table.items));
    return table;
}

std::vector<Table> tables_of(const Geometry& geometry) {
    std::vector<Table> tables{vertex_table(geometry)};
    if (!geometry.faces.empty()) tables.push_back(face_table(geometry));
    for (const Element& element : geometry.elements) {
        Table table{word(element.name), element.count, {}};
        for (const Property& p : element.properties) table.columns.push_back(column_of(p, element.count));
        tables.push_back(std::move(table));
    }
    return tables;
}

std::string header_of(const std::vector<Table>& tables, const std::vector<std::string>& comments, bool ascii) {
    constexpr bool little = std::endian::native == std::endian::little;
    std::string out = "ply\nformat ";
    out += ascii ? "ascii" : little ? "binary_little_endian" : "binary_big_endian";
    out += " 1.0\n";
    for (std::string comment : comments) {
        std::replace_if(
            comment.begin(), comment.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        out += (comment.starts_with("obj_info ") ? "" : "comment ") + comment + "\n";
    }
    for (const Table& table : tables) {
        out += "element " + table.name + " " + std::to_string(table.items) + "\n";
        for (const Column& c : table.columns) {
            out += "property ";
            if (c.list) out.append("list ").append(ply::type_name(c.count_type)).append(" ");
            out.append(ply::type_name(c.type)).append(" ").append(c.name).append("\n");
        }
    }
    return out + "end_header\n";
}

// ---- binary ----

std::size_t item_size(const Table& table, std::size_t item) {
    std::size_t size = 0;
    for (const Column& c : table.columns) {
        const auto [first, last] = c.values(item);
        size += (c.list ? size_of(c.count_type) : 0) + (last - first) * size_of(c.type);
    }
    return size;
}

/// Values [first, last) to where `to` points, which moves behind them.
template <class Stored, class Written>
void put_values(const Column& column, ValueRange values, char*& to) {
    for (std::size_t v = values.first; v < values.last; ++v, to += sizeof(Written)) {
        put(to, static_cast<Written>(value_at<Stored>(column.at(v))));
    }
}

/// One property of items begin, begin + 1, …, each behind what was written of the item before.
void put_column(const Column& column, std::size_t begin, std::vector<char*>& ends) {
    for (std::size_t i = 0; column.list && i < ends.size(); ++i) {
        const auto [first, last] = column.values(begin + i);
        with_type(column.count_type, [&, count = last - first](auto zero) {
            put(ends[i], static_cast<decltype(zero)>(count));
            ends[i] += sizeof zero;
        });
    }
    with_type(column.type, [&](auto zero) {
        using T = decltype(zero);
        for (std::size_t i = 0; i < ends.size(); ++i) {
            if (column.stored == column.type)
                put_values<T, T>(column, column.values(begin + i), ends[i]);
            else
                put_values<double, T>(column, column.values(begin + i), ends[i]);
        }
    });
}

/// Column by column in blocks that stay in the cache: the inner loops are over values of one type.
void append_binary(std::string& out, const Table& table) {
    constexpr std::size_t block = 2048;
    const std::size_t old = out.size();
    std::size_t size = old;
    for (std::size_t i = 0; i < table.items; ++i) size += item_size(table, i);
    out.resize(size);
    char* end = out.data() + old;
    std::vector<char*> ends;
    for (std::size_t begin = 0; begin < table.items; begin += block) {
        ends.resize(std::min(block, table.items - begin));
        for (std::size_t i = 0; i < ends.size(); ++i) {
            ends[i] = end;
            end += item_size(table, begin + i);
        }
        for (const Column& column : table.columns) put_column(column, begin, ends);
    }
}

// ---- ascii ----

void append_value(std::string& out, const Column& column, std::size_t value) {
    if (column.stored != column.type) return append_number(out, value_at<double>(column.at(value)), column.type);
    with_type(column.type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_floating_point_v<T>) {
            append_number(out, static_cast<double>(value_at<T>(column.at(value))), column.type);
        } else {
            out += std::to_string(value_at<T>(column.at(value)));
        }
    });
}

void append_ascii(std::string& out, const Table& table) {
    for (std::size_t i = 0; i < table.items; ++i) {
        const std::size_t begin = out.size();
        for (const Column& column : table.columns) {
            const auto [first, last] = column.values(i);
            if (column.list) out += std::to_string(last - first) + " ";
            for (std::size_t v = first; v < last; ++v) {
                append_value(out, column, v);
                out += ' ';
            }
        }
        if (out.size() > begin) out.back() = '\n';
    }
}

}  // namespace

std::string write_ply(const Geometry& geometry, const WriteOptions& options) {
    const std::vector<Table> tables = tables_of(geometry);
    std::string out = header_of(tables, geometry.comments, options.ascii);
    for (const Table& table : tables) {
        if (options.ascii)
            append_ascii(out, table);
        else
            append_binary(out, table);
    }
    return out;
}

}  // namespace gaussmap::io
