#include "carried_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace cli {
namespace {

using gaussmap::Decimation;
using gaussmap::Geometry;
using gaussmap::Property;
using gaussmap::SurfacePoint;

/// MeshLab's list of texture coordinates: u v of each of the three corners.
const Property* texture_coordinates(const Geometry& geometry) {
    for (const Property& p : geometry.face_properties) {
        if (!p.list || p.name != "texcoord") continue;
        for (std::size_t f = 0; f < geometry.face_count(); ++f)
            if (p.offsets[f + 1] - p.offsets[f] != 6) return nullptr;
        return &p;
    }
    return nullptr;
}

/// Item i of the property alone, appended to another of its kind.
void append_item(const Property& from, std::size_t i, Property& to) {
    const std::size_t size = gaussmap::size_of(from.type);
    const std::size_t first = from.list ? from.offsets[i] : i, last = from.list ? from.offsets[i + 1] : i + 1;
    to.bytes.insert(to.bytes.end(), from.bytes.begin() + static_cast<std::ptrdiff_t>(first * size),
                    from.bytes.begin() + static_cast<std::ptrdiff_t>(last * size));
    if (from.list) to.offsets.push_back(to.values());
}

/// A value of vertices at a point of the surface. What is undefined at one corner is left to the others.
template <class At>
double interpolated(const Geometry& from, const SurfacePoint& point, At&& at) {
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double value = point.weights[k] > 0 ? at(static_cast<std::size_t>(from.faces[3 * point.face + k])) : NAN;
        if (!std::isnan(value)) sum += point.weights[k] * value, weights += point.weights[k];
    }
    return weights > 0 ? sum / weights : NAN;
}

std::vector<double> interpolated_normals(const Geometry& from, const Decimation& made) {
    std::vector<double> normals;
    for (const SurfacePoint& point : made.vertex_source) {
        std::array<double, 3> n{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            n[axis] = interpolated(from, point, [&](std::size_t v) { return from.normals[3 * v + axis]; });
        const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (const double value : n) normals.push_back(value / length);
    }
    return normals;
}

Property interpolated_texture(const Property& from, const Decimation& made) {
    const std::vector<double> values = from.as_double();
    std::vector<double> out;
    for (std::size_t c = 0; c < made.faces.size(); ++c) {
        const SurfacePoint& point =
            made.corner_source.empty() ? made.vertex_source[made.faces[c]] : made.corner_source[c];
        for (std::size_t axis = 0; axis < 2; ++axis) {
            double sum = 0;
            for (std::size_t k = 0; k < 3; ++k)
                if (point.weights[k] > 0) sum += point.weights[k] * values[from.offsets[point.face] + 2 * k + axis];
            out.push_back(sum);
        }
    }
    Property property = gaussmap::make_property(from.name, out, from.type);
    property.list = true;
    property.count_type = from.count_type;
    for (std::size_t f = 0; f <= made.faces.size() / 3; ++f) property.offsets.push_back(6 * f);
    return property;
}

}  // namespace

std::vector<std::uint8_t> texture_seams(const Geometry& geometry) {
    const Property* texture = texture_coordinates(geometry);
    if (!texture) return {};
    return gaussmap::corner_seams(geometry.faces, texture->as_double(), 2);
}

bool has_values_to_carry(const Geometry& geometry) {
    const auto scalar = [](const Property& p) { return !p.list; };
    return !geometry.normals.empty() || texture_coordinates(geometry) ||
           std::any_of(geometry.vertex_properties.begin(), geometry.vertex_properties.end(), scalar);
}

Geometry carried_over(const Geometry& from, const Decimation& made) {
    Geometry out;
    out.vertices = made.vertices;
    out.faces = made.faces;
    out.vertex_type = from.vertex_type;
    out.normal_type = from.normal_type;
    out.comments = from.comments;
    out.notes = from.notes;
    if (!from.normals.empty()) out.normals = interpolated_normals(from, made);
    for (const Property& p : from.vertex_properties) {
        if (p.list) {
            out.notes.push_back("property " + p.name + " left out: lists of vertices cannot be interpolated");
            continue;
        }
        const std::vector<double> values = p.as_double();
        std::vector<double> carried;
        for (const SurfacePoint& point : made.vertex_source)
            carried.push_back(interpolated(from, point, [&](std::size_t v) { return values[v]; }));
        out.vertex_properties.push_back(gaussmap::make_property(p.name, carried, p.type));
    }
    const Property* texture = texture_coordinates(from);
    for (const Property& p : from.face_properties) {
        if (&p == texture) {
            out.face_properties.push_back(interpolated_texture(p, made));
            continue;
        }
        Property taken = p;
        taken.bytes.clear();
        taken.offsets.assign(p.list ? 1 : 0, 0);
        for (const std::int32_t f : made.face_source) append_item(p, static_cast<std::size_t>(f), taken);
        out.face_properties.push_back(std::move(taken));
    }
    return out;
}

}  // namespace cli
