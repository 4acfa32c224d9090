// gaussmap info: what a file holds, and what is wrong with it.
#include <fmt/format.h>

#include "files.h"
#include "gaussmap/inspect.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Geometry;
using gaussmap::Inspection;
using gaussmap::Property;

const char* name_of(gaussmap::Type type) {
    constexpr const char* names[] = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                     "uint32", "int64", "uint64", "float32", "float64"};
    return names[static_cast<std::size_t>(type)];
}

const char* name_of(gaussmap::Format format) {
    constexpr const char* names[] = {"unknown", "ply", "obj", "off", "stl", "xyz", "pcd"};
    return names[static_cast<std::size_t>(format)];
}

Json json_of(const std::vector<Property>& properties) {
    Json out = Json::array();
    for (const Property& p : properties) out.push_back({{"name", p.name}, {"type", name_of(p.type)}, {"list", p.list}});
    return out;
}

std::string text_of(const Json& attributes) {
    std::string out;
    for (const Json& a : attributes)
        out += fmt::format("{}{} ({}{})", out.empty() ? "" : ", ", a["name"].get<std::string>(),
                           a["list"].get<bool>() ? "list of " : "", a["type"].get<std::string>());
    return out.empty() ? "none" : out;
}

/// The counts, in the order in which they are shown.
Json defects(const Inspection& found, bool mesh) {
    Json out = {{"non_finite", found.non_finite}, {"duplicate_vertices", found.duplicate_vertices}};
    if (!mesh) return out;
    out["isolated_vertices"] = found.isolated_vertices;
    out["degenerate_faces"] = found.degenerate_faces;
    out["duplicate_faces"] = found.duplicate_faces;
    out["edges"] = found.edges;
    out["boundary_edges"] = found.boundary_edges;
    out["boundary_loops"] = found.boundary_loops;
    out["non_manifold_edges"] = found.non_manifold_edges;
    out["non_manifold_vertices"] = found.non_manifold_vertices;
    out["inconsistent_edges"] = found.inconsistent_edges;
    out["components"] = found.components;
    out["area"] = found.area;
    out["mean_edge"] = found.mean_edge;
    return out;
}

Json report_on(const std::string& path, const Geometry& geometry, const Inspection& found) {
    const bool mesh = !geometry.faces.empty();
    Json report = {{"file", path}, {"kind", mesh ? "mesh" : "cloud"}};
    report["format"] = name_of(geometry.format);
    report["vertices"] = found.vertices;
    report["faces"] = found.faces;
    report["polygons"] = geometry.polygons.empty() ? Json() : Json(geometry.polygons.count());
    report["width"] = geometry.width == 0 ? Json() : Json(geometry.width);
    report["vertex_type"] = name_of(geometry.vertex_type);
    report["normals"] = geometry.normals.empty() ? Json() : Json(name_of(geometry.normal_type));
    report["vertex_properties"] = json_of(geometry.vertex_properties);
    report["face_properties"] = json_of(geometry.face_properties);
    report["elements"] = Json::array();
    for (const gaussmap::Element& e : geometry.elements)
        report["elements"].push_back({{"name", e.name}, {"count", e.count}, {"properties", json_of(e.properties)}});
    report["comments"] = geometry.comments;
    if (found.vertices > found.non_finite)
        report["box"] = {{"minimum", found.minimum}, {"maximum", found.maximum}, {"diagonal", found.diagonal}};
    else
        report["box"] = nullptr;
    report.update(defects(found, mesh));
    report["notes"] = geometry.notes;
    return report;
}

std::string point(const Json& xyz) {
    return fmt::format("({}, {}, {})", number(xyz[0]), number(xyz[1]), number(xyz[2]));
}

void add_mesh_rows(Table& table, const Json& report) {
    const auto n = [&](const char* key) { return report[key].get<std::size_t>(); };
    table.add("edges", count(n("edges")) + ", mean length " + number(report["mean_edge"]));
    table.add("area", number(report["area"]));
    table.add("parts", count(n("components")));
    table.add("boundary", n("boundary_edges") == 0 ? std::string("none: closed")
                                                   : count(n("boundary_edges"), "edge", "edges") + " in " +
                                                         count(n("boundary_loops"), "loop", "loops"));
    table.add("non-manifold", count(n("non_manifold_edges"), "edge", "edges") + ", " +
                                  count(n("non_manifold_vertices"), "vertex", "vertices"));
    table.add("inconsistent",
              count(n("inconsistent_edges"), "edge", "edges") + " between faces that turn opposite ways");
    table.add("degenerate", count(n("degenerate_faces"), "face", "faces") + " of no area");
    table.add("duplicate faces", count(n("duplicate_faces")));
    table.add("isolated", count(n("isolated_vertices"), "vertex", "vertices") + " of no face");
}

Table table_of(const Json& report, bool mesh) {
    Table table;
    table.add("format", report["format"].get<std::string>());
    table.add("vertices", fmt::format("{} ({})", count(report["vertices"].get<std::size_t>()),
                                      report["vertex_type"].get<std::string>()));
    if (!report["width"].is_null()) table.add("organised", count(report["width"].get<std::size_t>()) + " points a row");
    if (mesh) {
        std::string faces = count(report["faces"].get<std::size_t>(), "triangle", "triangles");
        if (!report["polygons"].is_null())
            faces += ", from " + count(report["polygons"].get<std::size_t>(), "polygon", "polygons");
        table.add("faces", faces);
    }
    table.add("normals", report["normals"].is_null() ? "none" : report["normals"].get<std::string>());
    table.add("vertex values", text_of(report["vertex_properties"]));
    if (mesh) table.add("face values", text_of(report["face_properties"]));
    for (const Json& e : report["elements"])
        table.add("element", fmt::format("{}, {}: {}", e["name"].get<std::string>(), e["count"].get<std::size_t>(),
                                         text_of(e["properties"])));
    for (const Json& comment : report["comments"]) table.add("comment", comment.get<std::string>());
    const Json& box = report["box"];
    table.add("box", box.is_null() ? std::string("none") : point(box["minimum"]) + " to " + point(box["maximum"]));
    if (!box.is_null()) table.add("diagonal", number(box["diagonal"]));
    if (mesh) add_mesh_rows(table, report);
    table.add("duplicate", count(report["duplicate_vertices"].get<std::size_t>(), "vertex", "vertices") +
                               " at the position of an earlier one");
    table.add("non-finite",
              count(report["non_finite"].get<std::size_t>(), "vertex", "vertices") + " (NaN or infinite)");
    return table;
}

}  // namespace

void info(int argc, char** argv) {
    CommandLine line(
        "info IN [--json]",
        "Tells what a file holds: counts, attributes and their types, bounding box, and whatever may spoil "
        "a measurement: boundary, non-manifold, degenerate, duplicate, non-finite. Polygons are counted "
        "as the triangles they are cut into. Lengths and areas are in the unit of the file.",
        "gaussmap info bunny.ply              what is in it\n"
        "gaussmap info scan.pcd --json        the same facts for a script\n"
        "curl -s URL | gaussmap info -        from standard input");
    std::string path;
    line.input(path, "IN", "A mesh or a cloud: " + gaussmap::known_extensions() + "; - is standard input");
    if (!line.parse(argc, argv)) return;

    Stopwatch watch;
    const Geometry geometry = read_input(path, line.common);
    const double reading = watch.lap();
    const Inspection found = concerning(path, [&] { return gaussmap::inspect(geometry.vertices, geometry.faces); });
    Json report = report_on(path, geometry, found);
    report["seconds"] = {{"read", reading}, {"inspect", watch.lap()}, {"total", watch.total()}};
    report["peak_bytes"] = peak_bytes();
    const bool mesh = !geometry.faces.empty();
    present(report, fmt::format("{}: a {}", path, mesh ? "mesh" : "point cloud"), table_of(report, mesh), line.common);
}

}  // namespace cli
