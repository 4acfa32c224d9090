// The body of a PLY file: the values of each element in the order of the header. Every element is read into columns as
// it is declared; only then are vertices and faces told from the rest.
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "io/formats.h"
#include "io/ply_header.h"
#include "io/polygons.h"
#include "io/rows.h"
#include "io/types.h"
#include "parallel.h"

namespace gaussmap::io {

namespace {

using ply::Column;
using ply::Header;
using ply::mend;
using ply::Table;

constexpr std::size_t report_items = 1 << 16;  // items between two reports of progress

// ---- the body ----

struct Body {
    const Source& source;
    bool swap;
    std::string_view rest;
    std::size_t item = 0;  // of the element being read

    double fraction() const { return 1 - static_cast<double>(rest.size()) / static_cast<double>(source.bytes.size()); }
    void report() const {
        if (item % report_items == 0 && source.run.progress && !source.run.progress(fraction())) throw Cancelled();
    }
};

[[noreturn]] void cut_short(const Body& body, const Table& element) {
    fail(body.source, "element " + element.name,
         "the file ends after " + std::to_string(body.item) + " of " + std::to_string(element.count),
         "get the whole file");
}

/// No more items than the rest of the file can hold, whatever the header claims.
std::size_t possible_items(const Table& element, std::size_t bytes, bool ascii) {
    std::size_t least = 0;
    for (const Column& c : element.columns) {
        const Property& p = c.property;
        least += ascii ? 2 : size_of(p.list ? p.count_type : p.type);  // in ascii a digit and a separator
    }
    return least == 0 ? 0 : std::min(element.count, (bytes + (ascii ? 1 : 0)) / least);
}

void make_room(Table& element, std::size_t items) {
    for (Column& c : element.columns) {
        Property& p = c.property;
        if (p.list) p.offsets.reserve(items + 1), p.offsets.push_back(0);
        p.bytes.reserve(items * size_of(p.type));
    }
}

template <class T>
void append_value(Property& property, T value) {
    const std::size_t end = property.bytes.size();
    property.bytes.resize(end + sizeof value);
    put(property.bytes.data() + end, value);
}

// -- ascii: one item a line --

std::string line_of(const Body& body) {
    const std::string_view text = body.source.bytes;
    Lines lines(text.substr(0, text.size() - body.rest.size()));
    bool at_end = false;
    for (std::string_view line; lines.next(line);) at_end = lines.rest().empty();
    const char last = text[text.size() - body.rest.size() - 1];
    const bool next_line = at_end && (last == '\n' || last == '\r');
    return "line " + std::to_string(lines.number() + (next_line ? 1 : 0));
}

bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}

void skip_blanks(std::string_view& text, std::string_view blanks) {
    const std::size_t n = text.find_first_not_of(blanks);
    text.remove_prefix(n == text.npos ? text.size() : n);
}

/// A word as a value of an integer type, also where it is written as 3.0.
template <class T>
bool parse_as(std::string_view word, T& value) {
    double number = 0;
    if (!parse(word, number)) return false;
    if constexpr (!std::is_floating_point_v<T>) {
        if (number != std::floor(number) || number < static_cast<double>(std::numeric_limits<T>::min()) ||
            number >= std::ldexp(1.0, std::numeric_limits<T>::digits)) {
            return false;
        }
    }
    value = static_cast<T>(number);
    return true;
}

template <class T>
T read_word(Body& body, const Property& property, const Table& element) {
    std::string_view& rest = body.rest;
    while (!rest.empty() && (rest[0] == ' ' || (is_blank(rest[0]) && !is_line_end(rest[0])))) rest.remove_prefix(1);
    T value{};
    const char* const last = rest.data() + rest.size();
    const auto [end, error] = std::from_chars(rest.data(), last, value);
    if (error == std::errc() && (end == last || is_blank(*end))) {
        rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
        return value;
    }
    if (rest.empty()) cut_short(body, element);
    if (is_line_end(rest[0])) {
        fail(body.source, line_of(body), "too few values for element " + element.name + ": no " + property.name, mend);
    }
    std::string_view after = rest;
    const std::string_view word = next_word(after);
    if (!parse_as(word, value)) {
        fail(body.source, line_of(body),
             quoted(word) + " is no value for property " + property.name + " of element " + element.name, mend);
    }
    rest = after;
    return value;
}

void read_ascii_list(Body& body, Property& property, const Table& element) {
    const auto length = read_word<std::int64_t>(body, property, element);
    if (length < 0) {
        fail(body.source, line_of(body), "the list " + property.name + " has the length " + std::to_string(length),
             mend);
    }
    with_type(property.type, [&](auto zero) {
        using T = decltype(zero);
        for (std::int64_t i = 0; i < length; ++i) append_value(property, read_word<T>(body, property, element));
    });
    property.offsets.push_back(property.values());
}

void read_ascii(Body& body, Table& element) {
    make_room(element, possible_items(element, body.rest.size(), true));
    for (body.item = 0; body.item < element.count; ++body.item) {
        skip_blanks(body.rest, " \t\v\f\r\n");
        if (body.rest.empty()) cut_short(body, element);
        for (Column& c : element.columns) {
            Property& p = c.property;
            if (p.list) {
                read_ascii_list(body, p, element);
            } else {
                with_type(p.type, [&](auto zero) { append_value(p, read_word<decltype(zero)>(body, p, element)); });
            }
        }
        skip_blanks(body.rest, " \t\v\f");
        if (!body.rest.empty() && !is_line_end(body.rest[0])) {
            fail(body.source, line_of(body), "more values than the header declares for element " + element.name, mend);
        }
        body.report();
    }
}

// -- binary --

template <class T>
T in_order(const void* at, bool swap) {
    const T value = value_at<T>(at);
    return swap ? swapped(value) : value;
}

/// The length of a list; negative where an unsigned 64-bit one is beyond everything.
std::int64_t list_length(const Body& body, const Property& property, const char* at) {
    return with_type(property.count_type,
                     [&](auto zero) { return static_cast<std::int64_t>(in_order<decltype(zero)>(at, body.swap)); });
}

constexpr std::size_t grain = 1 << 13;  // items a block

/// Lay the columns over the file as the first record has them: the size of that record, or 0 where the file is shorter.
std::size_t lay_out(const Body& body, Table& element) {
    std::size_t at = 0;
    for (Column& c : element.columns) {
        const Property& p = c.property;
        if (p.list) {
            const std::size_t lengths = at;
            at += size_of(p.count_type);
            if (at > body.rest.size()) return 0;
            const std::int64_t length = list_length(body, p, body.rest.data() + lengths);
            if (length < 0 || static_cast<std::uint64_t>(length) > body.rest.size()) return 0;
            c.length = static_cast<std::size_t>(length);
        }
        c.first = body.rest.data() + at;
        at += c.length * size_of(p.type);
        if (at > body.rest.size()) return 0;
    }
    for (Column& c : element.columns) c.stride = at;
    return at;
}

/// Whether every list of every record is as long as in the first one.
bool is_uniform(const Body& body, const Table& element) {
    std::vector<char> differs(block_count(element.count, grain), 0);
    for (const Column& c : element.columns) {
        if (!c.property.list) continue;
        const char* const lengths = c.first - size_of(c.property.count_type);
        const Execution quiet{body.source.run.threads, {}};
        for_blocks(element.count, grain, quiet, [&](std::size_t block, std::size_t begin, std::size_t end) {
            with_type(c.property.count_type, [&](auto zero) {
                using T = decltype(zero);
                const T expected = value_at<T>(lengths);
                bool same = true;
                for (std::size_t i = begin; i < end; ++i) same &= value_at<T>(lengths + i * c.stride) == expected;
                if (!same) differs[block] = 1;
            });
        });
    }
    return std::find(differs.begin(), differs.end(), 1) == differs.end();
}

/// The next `count` values of the file.
void append_values(Body& body, Property& property, const Table& element, std::size_t count) {
    const std::size_t size = size_of(property.type);
    if (count > body.rest.size() / size) cut_short(body, element);
    with_type(property.type, [&](auto zero) {
        using T = decltype(zero);
        const std::size_t end = property.bytes.size();
        property.bytes.resize(end + count * sizeof(T));
        for (std::size_t v = 0; v < count * sizeof(T); v += sizeof(T)) {
            put(property.bytes.data() + end + v, in_order<T>(body.rest.data() + v, body.swap));
        }
    });
    body.rest.remove_prefix(count * size);
}

/// Record by record, where lists differ in length or the file is cut short.
void read_records(Body& body, Table& element) {
    make_room(element, possible_items(element, body.rest.size(), false));
    for (Column& c : element.columns) c.first = nullptr;
    for (body.item = 0; body.item < element.count; ++body.item) {
        for (Column& c : element.columns) {
            Property& p = c.property;
            std::int64_t length = 1;
            if (p.list) {
                if (body.rest.size() < size_of(p.count_type)) cut_short(body, element);
                length = list_length(body, p, body.rest.data());
                body.rest.remove_prefix(size_of(p.count_type));
            }
            if (length < 0) {
                fail(body.source, "element " + element.name + ", item " + std::to_string(body.item + 1),
                     "the list " + p.name + " has the length " + std::to_string(length), mend);
            }
            append_values(body, p, element, static_cast<std::size_t>(length));
            if (p.list) p.offsets.push_back(p.values());
        }
        body.report();
    }
}

void read_binary(Body& body, Table& element) {
    const std::size_t stride = lay_out(body, element);
    if (stride > 0 && element.count <= body.rest.size() / stride && is_uniform(body, element)) {
        body.rest.remove_prefix(element.count * stride);
    } else {
        read_records(body, element);
    }
}

void read_body(const Source& source, Header& header, Geometry& geometry) {
    Body body{source, header.swap, header.body};
    for (Table& element : header.elements) {
        if (element.count == 0 || element.columns.empty()) {
            make_room(element, 0);
        } else if (header.ascii) {
            read_ascii(body, element);
        } else {
            read_binary(body, element);
        }
    }
    if (header.ascii) skip_blanks(body.rest, " \t\v\f\r\n");
    if (!body.rest.empty()) {
        geometry.notes.push_back(counted(body.rest.size(), "byte") + " after the last element left out");
    }
}

// ---- vertices, faces, and the rest ----

/// What the second half needs beside the columns.
struct Context {
    const Source& source;
    bool swap;
    Execution quiet;
};

Column* find_column(Table& element, std::string_view name, bool list) {
    for (Column& c : element.columns) {
        if (c.property.name == name && c.property.list == list) return &c;
    }
    return nullptr;
}

Table* find_element(Header& header, std::string_view name) {
    for (Table& element : header.elements) {
        if (element.name == name) return &element;
    }
    return nullptr;
}

/// Call f(item, value) with value(v), the v-th value of the item, of the column's own type T, and their number.
template <class T, class F>
void each_item(const Column& column, bool swap, std::size_t begin, std::size_t end, const F& f) {
    const Property& p = column.property;
    if (column.first) {
        for (std::size_t i = begin; i < end; ++i) {
            const char* const from = column.first + i * column.stride;
            f(i, column.length, [&](std::size_t v) { return in_order<T>(from + v * sizeof(T), swap); });
        }
    } else {
        for (std::size_t i = begin; i < end; ++i) {
            const auto [first, last] = values_of(p, i);
            const std::byte* const from = p.bytes.data() + first * sizeof(T);
            f(i, last - first, [&](std::size_t v) { return value_at<T>(from + v * sizeof(T)); });
        }
    }
}

using Names = std::array<const char*, 3>;

/// Take three scalar properties as one array of doubles; false, and nothing done, where one of them is missing.
bool take_triple(const Context& context, Table& element, const Names& names, std::vector<double>& values, Type& type) {
    std::array<Column*, 3> columns{};
    for (std::size_t c = 0; c < 3; ++c) columns[c] = find_column(element, names[c], false);
    if (!columns[0] || !columns[1] || !columns[2]) return false;
    type = columns[0]->property.type;
    for (Column* column : columns) {
        if (column->property.type != type || !is_float(type)) type = Type::float64;
        column->taken = true;
    }
    values.resize(3 * element.count);
    for_blocks(element.count, grain, context.quiet, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t c = 0; c < 3; ++c) {
            with_type(columns[c]->property.type, [&](auto zero) {
                each_item<decltype(zero)>(
                    *columns[c], context.swap, begin, end,
                    [&](std::size_t i, std::size_t, auto value) { values[3 * i + c] = static_cast<double>(value(0)); });
            });
        }
    });
    return true;
}

/// The values of a column moved into its property.
Property property_of(const Context& context, Column& column, std::size_t count) {
    Property& p = column.property;
    if (!column.first) return std::move(p);
    p.bytes.resize(count * column.length * size_of(p.type));
    if (p.list) {
        p.offsets.resize(count + 1);
        for (std::size_t i = 0; i <= count; ++i) p.offsets[i] = i * column.length;
    }
    for_blocks(count, grain, context.quiet, [&](std::size_t, std::size_t begin, std::size_t end) {
        with_type(p.type, [&](auto zero) {
            std::byte* to = p.bytes.data() + begin * column.length * sizeof zero;
            each_item<decltype(zero)>(column, context.swap, begin, end,
                                      [&](std::size_t, std::size_t length, auto value) {
                                          for (std::size_t v = 0; v < length; ++v, to += sizeof zero) put(to, value(v));
                                      });
        });
    });
    return std::move(p);
}

/// The properties that nothing has taken.
std::vector<Property> other_properties(const Context& context, Table& element) {
    std::vector<Property> properties;
    for (Column& c : element.columns) {
        if (!c.taken) properties.push_back(property_of(context, c, element.count));
    }
    return properties;
}

/// Call f(corners) for every list of vertex indices.
template <class F>
void each_list(const Context& context, const Table& element, const Column& column, const F& f) {
    std::vector<std::int32_t> corners;
    with_type(column.property.type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_floating_point_v<T>) {
            fail(context.source, "header", "the list " + column.property.name + " is not of whole numbers", mend);
        } else {
            each_item<T>(column, context.swap, 0, element.count, [&](std::size_t i, std::size_t length, auto value) {
                corners.resize(length);
                for (std::size_t c = 0; c < length; ++c) {
                    const T index = value(c);
                    if (!std::in_range<std::int32_t>(index)) {
                        fail(context.source,
                             element.name + " " + std::to_string(i + 1) + ", corner " + std::to_string(c + 1),
                             "vertex index " + std::to_string(index) + " is beyond 32 bits", mend);
                    }
                    corners[c] = static_cast<std::int32_t>(index);
                }
                f(std::as_const(corners));
            });
        }
    });
}

/// Triangles of a strip: each with the two vertices before it, every second one turned over; −1 begins a new strip.
/// Triangles that name a vertex twice only carry the strip to another place.
void add_strip(const std::vector<std::int32_t>& strip, FaceList& faces) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < strip.size(); ++i) {
        if (strip[i] == -1) {
            begin = i + 1;
        } else if (i >= begin + 2) {
            const std::int32_t a = strip[i - 2], b = strip[i - 1], c = strip[i];
            if (a == b || b == c || a == c) continue;
            if ((i - begin) % 2 == 0)
                faces.add_triangle(a, b, c);
            else
                faces.add_triangle(b, a, c);
        }
    }
}

void take_faces(const Context& context, Table& element, FaceList& faces, Geometry& geometry) {
    Column* indices = find_column(element, "vertex_indices", true);
    if (!indices) indices = find_column(element, "vertex_index", true);
    if (!indices) fail(context.source, "header", "element face has no list vertex_indices", mend);
    indices->taken = true;
    faces.reserve(element.count);
    each_list(context, element, *indices, [&](const std::vector<std::int32_t>& corners) { faces.add(corners); });
    if (faces.count() == 0) return;
    geometry.face_properties = other_properties(context, element);
    if (faces.dropped().empty()) return;
    std::vector<std::uint64_t> kept;
    auto dropped = faces.dropped().begin();
    for (std::size_t i = 0; i < element.count; ++i) {
        if (dropped != faces.dropped().end() && *dropped == i)
            ++dropped;
        else
            kept.push_back(i);
    }
    for (Property& p : geometry.face_properties) p = select_rows(p, kept);
}

void take_vertices(const Context& context, Table& element, Geometry& geometry) {
    const Names xyz = {"x", "y", "z"};
    if (!take_triple(context, element, xyz, geometry.vertices, geometry.vertex_type)) {
        std::string missing;
        for (const char* name : xyz) {
            if (!find_column(element, name, false)) missing += (missing.empty() ? "" : ", ") + std::string(name);
        }
        fail(context.source, "header", "element vertex has no property " + missing, mend);
    }
    take_triple(context, element, {"nx", "ny", "nz"}, geometry.normals, geometry.normal_type);
    geometry.vertex_properties = other_properties(context, element);
}

void take_elements(const Context& context, Header& header, Geometry& geometry) {
    Table* const vertex = find_element(header, "vertex");
    if (!vertex) fail(context.source, "header", "no element vertex", "give a file of points or of a surface");
    take_vertices(context, *vertex, geometry);
    FaceList faces;
    Table* const face = find_element(header, "face");
    if (face && face->count > 0) take_faces(context, *face, faces, geometry);
    Table* const strips = find_element(header, "tristrips");
    Column* const strip = strips && faces.count() == 0 ? find_column(*strips, "vertex_indices", true) : nullptr;
    if (strip) {
        each_list(context, *strips, *strip,
                  [&](const std::vector<std::int32_t>& corners) { add_strip(corners, faces); });
    }
    faces.finish(geometry, context.source);
    for (Table& element : header.elements) {
        if (&element == vertex || &element == face || (&element == strips && strip)) continue;
        geometry.elements.push_back({element.name, element.count, other_properties(context, element)});
    }
}

}  // namespace

Geometry read_ply(const Source& source) {
    Geometry geometry;
    Header header = ply::read_header(source);
    read_body(source, header, geometry);
    take_elements({source, header.swap, {source.run.threads, {}}}, header, geometry);
    geometry.comments = std::move(header.comments);
    return geometry;
}

}  // namespace gaussmap::io
