// io.h for Python: a geometry as a record of everything that it holds, and back.
#include <algorithm>

#include "arrays.h"
#include "bindings.h"
#include "execution.h"
#include "gaussmap/io.h"

namespace binding {
namespace {

using namespace nb::literals;
using gaussmap::Geometry;
using gaussmap::Type;

using AnyArray = nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu>;
template <class T>
using Values = nb::ndarray<const T, nb::c_contig, nb::device::cpu>;

struct Kind {
    Type type;
    const char* name;
    nb::dlpack::dtype dtype;
};

const Kind kinds[] = {
    {Type::int8, "int8", nb::dtype<std::int8_t>()},    {Type::uint8, "uint8", nb::dtype<std::uint8_t>()},
    {Type::int16, "int16", nb::dtype<std::int16_t>()}, {Type::uint16, "uint16", nb::dtype<std::uint16_t>()},
    {Type::int32, "int32", nb::dtype<std::int32_t>()}, {Type::uint32, "uint32", nb::dtype<std::uint32_t>()},
    {Type::int64, "int64", nb::dtype<std::int64_t>()}, {Type::uint64, "uint64", nb::dtype<std::uint64_t>()},
    {Type::float32, "float32", nb::dtype<float>()},    {Type::float64, "float64", nb::dtype<double>()},
};

const Kind& kind_of(Type type) {
    return *std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind& kind) { return kind.type == type; });
}

Type type_named(const std::string& name) {
    for (const Kind& kind : kinds)
        if (name == kind.name) return kind.type;
    throw std::invalid_argument("the type '" + name + "' is none that files hold");
}

Type type_of(nb::dlpack::dtype dtype, const std::string& name) {
    for (const Kind& kind : kinds)
        if (dtype == kind.dtype) return kind.type;
    throw std::invalid_argument(name + " has values of a type that files do not hold");
}

gaussmap::Format format_named(const std::string& name) {
    using gaussmap::Format;
    return named<Format>("format", name,
                         {{"", Format::detect},
                          {"ply", Format::ply},
                          {"obj", Format::obj},
                          {"off", Format::off},
                          {"stl", Format::stl},
                          {"xyz", Format::xyz},
                          {"pcd", Format::pcd}});
}

const char* name_of(gaussmap::Format format) {
    constexpr const char* names[] = {"", "ply", "obj", "off", "stl", "xyz", "pcd"};
    return names[static_cast<std::size_t>(format)];
}

nb::object values_of(gaussmap::Property&& property) {
    const std::size_t count = property.values();
    auto* kept = new std::vector<std::byte>(std::move(property.bytes));
    const nb::capsule owner(kept, [](void* bytes) noexcept { delete static_cast<std::vector<std::byte>*>(bytes); });
    if (kept->empty()) kept->reserve(1);
    return nb::cast(nb::ndarray<nb::numpy>(kept->data(), 1, &count, owner, nullptr, kind_of(property.type).dtype));
}

nb::list properties_out(std::vector<gaussmap::Property>&& properties) {
    nb::list out;
    for (gaussmap::Property& property : properties) {
        const std::string name = property.name, count_type = kind_of(property.count_type).name;
        nb::object offsets = property.list ? nb::object(array(std::move(property.offsets))) : nb::none();
        out.append(nb::make_tuple(name, values_of(std::move(property)), offsets, count_type));
    }
    return out;
}

std::vector<gaussmap::Property> properties_in(const nb::handle& list) {
    std::vector<gaussmap::Property> out;
    for (const nb::handle item : nb::cast<nb::list>(list)) {
        const auto [name, values, offsets, count_type] =
            nb::cast<std::tuple<std::string, AnyArray, std::optional<Values<std::uint64_t>>, std::string>>(item);
        gaussmap::Property property;
        property.name = name;
        property.type = type_of(values.dtype(), name);
        property.count_type = type_named(count_type);
        const auto* bytes = static_cast<const std::byte*>(values.data());
        property.bytes.assign(bytes, bytes + values.nbytes());
        property.list = offsets.has_value();
        if (offsets) property.offsets.assign(offsets->data(), offsets->data() + offsets->size());
        out.push_back(std::move(property));
    }
    return out;
}

template <class T>
std::vector<T> vector_of(const nb::handle& array) {
    if (array.is_none()) return {};
    const auto values = nb::cast<Values<T>>(array);
    return {values.data(), values.data() + values.size()};
}

Record record_of(Geometry&& geometry) {
    Record out;
    out["vertices"] = array(std::move(geometry.vertices), 3);
    out["faces"] = array_or_none(std::move(geometry.faces), 3);
    out["normals"] = array_or_none(std::move(geometry.normals), 3);
    out["vertex_type"] = kind_of(geometry.vertex_type).name;
    out["normal_type"] = kind_of(geometry.normal_type).name;
    out["vertex_properties"] = properties_out(std::move(geometry.vertex_properties));
    out["face_properties"] = properties_out(std::move(geometry.face_properties));
    out["polygons"] =
        geometry.polygons.empty()
            ? nb::none()
            : nb::object(nb::make_tuple(
                  array(std::move(geometry.polygons.offsets)), array(std::move(geometry.polygons.corners)),
                  array(std::move(geometry.polygon_of)), array(std::move(geometry.polygon_corner), 3)));
    nb::list elements;
    for (gaussmap::Element& element : geometry.elements)
        elements.append(nb::make_tuple(element.name, element.count, properties_out(std::move(element.properties))));
    out["elements"] = elements;
    out["comments"] = nb::cast(geometry.comments);
    out["notes"] = nb::cast(geometry.notes);
    out["width"] = geometry.width;
    out["format"] = name_of(geometry.format);
    return out;
}

Geometry geometry_of(const Record& record) {
    Geometry out;
    out.vertices = vector_of<double>(record["vertices"]);
    out.faces = vector_of<std::int32_t>(record["faces"]);
    out.normals = vector_of<double>(record["normals"]);
    out.vertex_type = type_named(nb::cast<std::string>(record["vertex_type"]));
    out.normal_type = type_named(nb::cast<std::string>(record["normal_type"]));
    out.vertex_properties = properties_in(record["vertex_properties"]);
    out.face_properties = properties_in(record["face_properties"]);
    if (!record["polygons"].is_none()) {
        const nb::tuple polygons = nb::cast<nb::tuple>(record["polygons"]);
        out.polygons.offsets = vector_of<std::uint64_t>(polygons[0]);
        out.polygons.corners = vector_of<std::int32_t>(polygons[1]);
        out.polygon_of = vector_of<std::int32_t>(polygons[2]);
        out.polygon_corner = vector_of<std::int32_t>(polygons[3]);
    }
    for (const nb::handle item : nb::cast<nb::list>(record["elements"])) {
        const nb::tuple element = nb::cast<nb::tuple>(item);
        out.elements.push_back(
            {nb::cast<std::string>(element[0]), nb::cast<std::size_t>(element[1]), properties_in(element[2])});
    }
    out.comments = nb::cast<std::vector<std::string>>(record["comments"]);
    out.width = nb::cast<std::size_t>(record["width"]);
    return out;
}

Record read(const std::string& path, const std::string& format, int threads, const nb::object& progress) {
    const gaussmap::Format known = format_named(format);
    return record_of(
        released(threads, progress, [&](const gaussmap::Execution& run) { return gaussmap::read(path, known, run); }));
}

void write(const std::string& path, const Record& record, const std::string& format, bool ascii) {
    const gaussmap::WriteOptions options = {format_named(format), ascii, false};
    const Geometry geometry = geometry_of(record);
    const nb::gil_scoped_release release;
    gaussmap::write(path, geometry, options);
}

Record triangulate(const Record& record) {
    return record_of(gaussmap::triangulate(geometry_of(record)));
}

Record weld(const Record& record) {
    return record_of(gaussmap::weld(geometry_of(record)));
}

}  // namespace

void bind_files(nb::module_& m) {
    m.def("read", read, "path"_a, "format"_a, "threads"_a, "progress"_a.none());
    m.def("write", write, "path"_a, "geometry"_a, "format"_a, "ascii"_a);
    m.def(
        "write_file",
        [](const std::string& path, const std::string& text) {
            const nb::gil_scoped_release release;
            gaussmap::write_file(path, text);
        },
        "path"_a, "text"_a);
    m.def("triangulate", triangulate, "geometry"_a);
    m.def("weld", weld, "geometry"_a);
    m.def("known_extensions", &gaussmap::known_extensions);
}

}  // namespace binding
