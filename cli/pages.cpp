#include "pages.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace cli {
namespace {

/// Parts of something else than a value.
bool is_part(const std::string& name) {
    static const std::vector<std::string> parts = {"red", "green", "blue", "alpha", "d1x", "d1y", "d1z"};
    return std::find(parts.begin(), parts.end(), name) != parts.end();
}

bool same(double a, double b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

gaussmap::PageScene page_scene(const std::string& path, const gaussmap::Geometry& geometry, bool mesh,
                               const std::vector<double>& normals) {
    gaussmap::PageScene scene;
    scene.name = path == "-" ? "standard input" : std::filesystem::path(path).filename().string();
    scene.vertices = geometry.vertices;
    if (mesh) scene.faces = geometry.faces;
    if (!normals.empty()) {
        scene.normals = normals;
    } else if (has_normals(geometry)) {
        scene.normals = geometry.normals;
    }
    return scene;
}

void add_measured(gaussmap::PageScene& scene, const std::string& name, const std::vector<double>& values,
                  bool of_faces) {
    gaussmap::add_field(scene, name, gaussmap::make_property(name, values).as_double(), of_faces);
}

void add_properties(gaussmap::PageScene& scene, const std::vector<gaussmap::Property>& properties, bool of_faces) {
    for (const gaussmap::Property& property : properties) {
        if (property.list || is_part(property.name)) continue;
        std::vector<double> values = property.as_double();
        // `quality` repeats `scalar_total_curvature`, for MeshLab.
        const bool known = std::any_of(scene.fields.begin(), scene.fields.end(), [&](const gaussmap::PageField& field) {
            return field.of_faces == of_faces &&
                   (field.name == property.name ||
                    std::equal(values.begin(), values.end(), field.values.begin(), field.values.end(), same));
        });
        if (!known) gaussmap::add_field(scene, property.name, std::move(values), of_faces);
    }
}

void write_pages(const Outputs& outputs, const std::vector<gaussmap::PageScene>& scenes, gaussmap::PageOptions options,
                 const Common& common) {
    options.title.clear();
    for (const gaussmap::PageScene& scene : scenes)
        options.title.append(options.title.empty() ? "" : " · ").append(scene.name);
    std::string page;
    {
        Progress progress("making the page", common.quiet);
        options.run = progress.run(common.threads);
        page = gaussmap::page_html(scenes, options);
    }
    for (const std::string& path : outputs.paths)
        if (outputs.is_page(path)) gaussmap::write_file(path, page);
}

}  // namespace cli
