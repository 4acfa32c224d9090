// Properties of any type, and what formats are called.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "gaussmap/io.h"
#include "io/types.h"

namespace gaussmap {

namespace {

struct Extension {
    std::string_view text;
    Format format;
};
constexpr std::array<Extension, 10> extensions = {{{".ply", Format::ply},
                                                   {".obj", Format::obj},
                                                   {".off", Format::off},
                                                   {".stl", Format::stl},
                                                   {".xyz", Format::xyz},
                                                   {".pwn", Format::xyz},
                                                   {".pts", Format::xyz},
                                                   {".asc", Format::xyz},
                                                   {".txt", Format::xyz},
                                                   {".pcd", Format::pcd}}};

/// The value of T nearest to v; NaN becomes 0 where T is an integer.
template <class T>
T nearest(double v) {
    if constexpr (std::is_floating_point_v<T>) {
        return static_cast<T>(v);
    } else {
        // Both limits as doubles are exact or round away from 0, so clamping comes before the conversion.
        if (std::isnan(v)) return 0;
        if (v <= static_cast<double>(std::numeric_limits<T>::min())) return std::numeric_limits<T>::min();
        if (v >= static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::max();
        return static_cast<T>(std::nearbyint(v));
    }
}

}  // namespace

std::size_t size_of(Type type) {
    return io::with_type(type, [](auto zero) { return sizeof zero; });
}

double Property::at(std::size_t i) const {
    return io::with_type(type, [&](auto zero) {
        return static_cast<double>(io::value_at<decltype(zero)>(bytes.data() + i * sizeof zero));
    });
}

std::vector<double> Property::as_double() const {
    std::vector<double> out(values());
    io::with_type(type, [&](auto zero) {
        const std::byte* from = bytes.data();
        for (double& v : out) v = static_cast<double>(io::value_at<decltype(zero)>(from)), from += sizeof zero;
    });
    return out;
}

Property make_property(std::string name, const std::vector<double>& values, Type type) {
    Property property;
    property.name = std::move(name);
    property.type = type;
    io::with_type(type, [&](auto zero) {
        property.bytes.resize(values.size() * sizeof zero);
        std::byte* to = property.bytes.data();
        for (const double v : values) io::put(to, nearest<decltype(zero)>(v)), to += sizeof zero;
    });
    return property;
}

const Property* Geometry::vertex_property(std::string_view name) const {
    const auto found = std::find_if(vertex_properties.begin(), vertex_properties.end(),
                                    [&](const Property& p) { return p.name == name; });
    return found == vertex_properties.end() ? nullptr : &*found;
}

Format format_of(std::string_view path) {
    for (const auto& [text, format] : extensions) {
        if (path.size() < text.size()) continue;
        const std::string_view end = path.substr(path.size() - text.size());
        const auto same = [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); };
        if (std::equal(text.begin(), text.end(), end.begin(), same)) return format;
    }
    return Format::detect;
}

std::string known_extensions() {
    std::string all;
    for (const auto& [text, format] : extensions) all.append(all.empty() ? "" : ", ").append(text);
    return all;
}

namespace io {

namespace {

void check_properties(const std::vector<Property>& properties, std::size_t items, const std::string& of) {
    for (const Property& p : properties) {
        const std::string name = of + " property " + p.name;
        if (item_count(p) != items) {
            throw std::invalid_argument(name + " has " + std::to_string(item_count(p)) + " entries, but there are " +
                                        std::to_string(items));
        }
        const bool rising = std::is_sorted(p.offsets.begin(), p.offsets.end());
        if (p.list && items > 0 && (!rising || p.offsets.back() > p.values())) {
            throw std::invalid_argument(name + ": offsets do not rise to at most " + std::to_string(p.values()));
        }
    }
}

void check_indices(const std::vector<std::int32_t>& indices, std::size_t vertices, const std::string& of) {
    const auto outside = [&](std::int32_t v) { return v < 0 || static_cast<std::size_t>(v) >= vertices; };
    const auto bad = std::find_if(indices.begin(), indices.end(), outside);
    if (bad == indices.end()) return;
    throw std::invalid_argument(of + "[" + std::to_string(bad - indices.begin()) + "] = " + std::to_string(*bad) +
                                " is outside [0, " + std::to_string(vertices) + ")");
}

void check_length(const char* array, std::size_t length, std::size_t expected) {
    if (length == expected) return;
    throw std::invalid_argument(std::string(array) + " has " + std::to_string(length) + " values, but should have " +
                                std::to_string(expected));
}

}  // namespace

Property select_rows(const Property& property, std::span<const std::uint64_t> rows) {
    Property out = property;
    out.bytes.clear();
    out.offsets.clear();
    if (property.list) out.offsets.push_back(0);
    const std::size_t size = size_of(property.type);
    for (const std::uint64_t row : rows) {
        const auto [first, last] = values_of(property, row);
        const std::byte* const from = property.bytes.data();
        out.bytes.insert(out.bytes.end(), from + first * size, from + last * size);
        if (property.list) out.offsets.push_back(out.values());
    }
    return out;
}

void check(const Geometry& g) {
    check_length("vertices", g.vertices.size(), 3 * g.vertex_count());
    check_length("normals", g.normals.size(), g.normals.empty() ? 0 : g.vertices.size());
    check_length("faces", g.faces.size(), 3 * g.face_count());
    check_indices(g.faces, g.vertex_count(), "faces");
    check_properties(g.vertex_properties, g.vertex_count(), "vertex");
    check_properties(g.face_properties, g.polygons.empty() ? g.face_count() : g.polygons.count(), "face");
    for (const Element& e : g.elements) check_properties(e.properties, e.count, "element " + e.name + ":");
    if (g.polygons.empty()) return;
    check_length("polygon_of", g.polygon_of.size(), g.face_count());
    check_length("polygon_corner", g.polygon_corner.size(), g.faces.size());
    const std::vector<std::uint64_t>& offsets = g.polygons.offsets;
    if (!std::is_sorted(offsets.begin(), offsets.end()) || offsets.back() > g.polygons.corners.size()) {
        throw std::invalid_argument("polygons.offsets do not rise to at most " +
                                    std::to_string(g.polygons.corners.size()));
    }
    check_indices(g.polygons.corners, g.vertex_count(), "polygons.corners");
    check_indices(g.polygon_of, g.polygons.count(), "polygon_of");
    for (std::size_t i = 0; i < g.polygon_corner.size(); ++i) {
        const auto polygon = static_cast<std::size_t>(g.polygon_of[i / 3]);
        const std::size_t size = offsets[polygon + 1] - offsets[polygon];
        if (static_cast<std::uint32_t>(g.polygon_corner[i]) < size) continue;
        throw std::invalid_argument("polygon_corner[" + std::to_string(i) +
                                    "] = " + std::to_string(g.polygon_corner[i]) + " is outside [0, " +
                                    std::to_string(size) + ")");
    }
}

}  // namespace io

}  // namespace gaussmap
