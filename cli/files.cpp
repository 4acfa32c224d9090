#include "files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "gaussmap/page.h"
#include "report.h"

namespace cli {
namespace {

using gaussmap::Format;

const std::vector<std::string> format_names = {"ply", "obj", "off", "stl", "xyz", "pcd"};
constexpr Format formats[] = {Format::ply, Format::obj, Format::off, Format::stl, Format::xyz, Format::pcd};

bool holds_faces(Format format) {
    return format != Format::xyz && format != Format::pcd;
}
bool holds_normals(Format format) {
    return format != Format::stl;
}

bool holds(Format format, const gaussmap::Property& property, bool of_faces) {
    const std::string& name = property.name;
    const bool colour = property.type == gaussmap::Type::uint8 && (name == "red" || name == "green" || name == "blue");
    switch (format) {
        case Format::ply:
            return true;
        case Format::obj:
            return of_faces ? name == "texcoord" : colour;
        case Format::off:
            return colour || name == "alpha";
        case Format::xyz:
        case Format::pcd:
            return !of_faces && !property.list;
        default:
            return false;
    }
}

void check_folder(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const std::string name = folder.empty() ? "." : folder.string();
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw Failure(Exit::failed, path + ": is a folder; name a file in it");
    if (!std::filesystem::is_directory(name, ignored))
        throw Failure(Exit::failed, fmt::format("{}: the folder '{}' does not exist; make it first", path, name));
    if (::access(name.c_str(), W_OK | X_OK) != 0)
        throw Failure(Exit::failed, fmt::format("{}: no permission to write into the folder '{}'", path, name));
}

bool ends_in(const std::string& path, const std::string& extension) {
    std::string end = path.substr(path.size() - std::min(extension.size(), path.size()));
    for (char& c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return end == extension;
}

/// What of the geometry the format has no place for.
std::vector<std::string> lost(const gaussmap::Geometry& geometry, Format format) {
    std::vector<std::string> out;
    if (format == Format::ply) return out;
    if (geometry.face_count() > 0 && !holds_faces(format)) out.push_back("faces");
    if (!geometry.normals.empty() && !holds_normals(format)) out.push_back("normals");
    for (const gaussmap::Property& property : geometry.vertex_properties)
        if (!holds(format, property, false)) out.push_back(property.name);
    for (const gaussmap::Property& property : geometry.face_properties)
        if (!holds(format, property, true)) out.push_back(property.name + " of the faces");
    if (format == Format::stl && !geometry.polygons.empty()) out.push_back("polygons (triangles are written)");
    for (const gaussmap::Element& element : geometry.elements) out.push_back("element " + element.name);
    return out;
}

}  // namespace

void Outputs::declare(CommandLine& line, bool required) {
    line.group("Output");
    const std::string formats_of_geometry = ".ply .obj .off .stl .xyz .pcd";
    std::string known = geometries ? formats_of_geometry : "";
    for (const auto& [taken, extension] : {std::pair(pictures, ".png"), std::pair(pages, ".html")})
        if (taken) known.append(known.empty() ? "" : " ").append(extension);
    line.outputs(paths, required, known);
    if (!geometries) return;
    line.option("--format", format_name, "F", "Format of -o -: ply, obj, off, stl, xyz or pcd (default: ply)",
                one_of(format_names));
    line.flag("--ascii", ascii, "Text instead of binary, where the format has both (.ply .stl .pcd)");
}

Format Outputs::format(const std::string& path) const {
    if (path != "-") return gaussmap::format_of(path);
    const auto name = std::find(format_names.begin(), format_names.end(), format_name);
    return formats[name - format_names.begin()];
}

void Outputs::check(const CommandLine& line) const {
    for (auto path = paths.begin(); path != paths.end(); ++path) {
        if (std::find(paths.begin(), path, *path) != path)
            throw Failure(Exit::wrong_usage, fmt::format("-o {}: named twice; give each file its own name", *path));
        if (*path == "-") {
            if (line.common.json)
                throw Failure(Exit::wrong_usage, "-o - and --json both want standard output; write to a file instead");
            continue;
        }
        if (is_geometry(*path) && (!geometries || format(*path) == Format::detect)) {
            std::vector<std::string> known;
            if (geometries) known.push_back(gaussmap::known_extensions());
            if (pictures) known.emplace_back(".png");
            if (pages) known.emplace_back(".html");
            throw Failure(Exit::wrong_usage, fmt::format("{}: unknown extension of an output; the known ones are {}",
                                                         *path, fmt::join(known, ", ")));
        }
        if (const std::string obstacle = gaussmap::page_obstacle(); is_page(*path) && !obstacle.empty())
            throw Failure(Exit::failed, fmt::format("{}: this gaussmap was {}", *path, obstacle));
        check_folder(*path);
    }
    if (geometries && line.given("--format") && std::find(paths.begin(), paths.end(), "-") == paths.end())
        throw Failure(Exit::wrong_usage, "--format is for -o - alone; the extension of a file decides");
}

void Outputs::check_fit(const gaussmap::Geometry& geometry) const {
    if (!geometry.faces.empty()) return;
    for (const std::string& path : paths)
        if (is_geometry(path) && format(path) == Format::stl)
            throw Failure(Exit::wrong_usage,
                          path + ": STL holds nothing but triangles, and there are none; write .ply");
}

bool Outputs::is_picture(const std::string& path) const {
    if (path == "-") return !geometries;
    return pictures && ends_in(path, ".png");
}

bool Outputs::is_page(const std::string& path) const {
    return pages && ends_in(path, ".html");
}

bool Outputs::any_picture() const {
    return std::any_of(paths.begin(), paths.end(), [&](const std::string& path) { return is_picture(path); });
}

bool Outputs::any_page() const {
    return std::any_of(paths.begin(), paths.end(), [&](const std::string& path) { return is_page(path); });
}

bool Outputs::any_geometry() const {
    return std::any_of(paths.begin(), paths.end(), [&](const std::string& path) { return is_geometry(path); });
}

void Outputs::write(const gaussmap::Geometry& geometry) const {
    for (const std::string& path : paths)
        if (is_geometry(path)) gaussmap::write(path, geometry, {format(path), ascii, false});
}

std::vector<std::string> Outputs::losses(const gaussmap::Geometry& geometry) const {
    std::vector<std::string> out;
    for (const std::string& path : paths) {
        if (!is_geometry(path)) continue;
        const std::vector<std::string> what = lost(geometry, format(path));
        if (!what.empty())
            out.push_back(fmt::format("{} has no place for: {}; .ply has", path == "-" ? "the output" : path,
                                      fmt::join(what, ", ")));
    }
    return out;
}

void report_written(Json& report, const Outputs& outputs, const gaussmap::Geometry& written) {
    report["peak_bytes"] = peak_bytes();
    report["outputs"] = outputs.paths;
    report["notes"] = written.notes;
    for (const std::string& loss : outputs.losses(written)) report["notes"].push_back(loss);
}

gaussmap::Geometry read_input(const std::string& path, const Common& common) {
    Progress progress("reading", common.quiet);
    return gaussmap::read(path, Format::detect, progress.run(common.threads));
}

bool taken_as_mesh(const std::string& as, const gaussmap::Geometry& geometry, const std::string& path) {
    if (geometry.vertices.empty())
        throw Failure(Exit::bad_input, path + ": holds no points; there is nothing to measure");
    if (as == "mesh" && geometry.faces.empty())
        throw Failure(Exit::bad_input, path + ": holds no faces; leave out --as mesh to take it as a cloud");
    return as != "cloud" && !geometry.faces.empty();
}

bool has_normals(const gaussmap::Geometry& geometry) {
    for (std::size_t i = 0; i + 2 < geometry.normals.size(); i += 3) {
        const double x = geometry.normals[i], y = geometry.normals[i + 1], z = geometry.normals[i + 2];
        if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && (x != 0 || y != 0 || z != 0)) return true;
    }
    return false;
}

const gaussmap::Property& vertex_property(const gaussmap::Geometry& geometry, const std::string& name,
                                          const std::string& path, const char* purpose) {
    if (const gaussmap::Property* property = geometry.vertex_property(name); property && !property->list)
        return *property;
    std::vector<std::string> names;
    for (const gaussmap::Property& p : geometry.vertex_properties)
        if (!p.list) names.push_back(p.name);
    std::string hint = did_you_mean(name, names);
    if (hint.empty()) hint = names.empty() ? "; it has none of one number a vertex" : "; it has " + listed(names);
    throw Failure(Exit::bad_input, fmt::format("{}: has no vertex property '{}' {}{}", path, name, purpose, hint));
}

void set_property(std::vector<gaussmap::Property>& properties, gaussmap::Property property) {
    const auto same = std::find_if(properties.begin(), properties.end(),
                                   [&](const gaussmap::Property& p) { return p.name == property.name; });
    if (same == properties.end()) {
        properties.push_back(std::move(property));
    } else {
        *same = std::move(property);
    }
}

}  // namespace cli
