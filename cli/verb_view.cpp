// gaussmap view: a page or a picture of the curvature, or of any other value the file has.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "gaussmap/curvature.h"
#include "pages.h"
#include "pictures.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Geometry;

struct Options {
    std::string input, second, as = "auto", field, size = "1600x1200", from, up, range;
    gaussmap::PictureOptions picture;
    Outputs outputs;
};

constexpr const char* about =
    "Shows a mesh or a cloud, coloured by its total curvature or by a property of its vertices: as a page (.html), "
    "or as a picture (.png) drawn without a display. A page is one file that needs no network: turn it, choose "
    "values, colours and range, point at it for numbers. Two inputs stand side by side on a page, and turn together. "
    "The same input gives the same bytes.\n\n"
    "Colours begin at 0 and end at the 98th percentile; what lies beyond has the last colour, and the legend a point "
    "there. Curvatures that have a sign (k1, k2, mean, gaussian, shape_index) are blue below 0 and red above, as far "
    "as "
    "either way. A plane is drawn as a plane, whatever its rounding noise. What is undefined is grey, and counted.\n\n"
    "Without --from, one looks along the shortest side, a little from the right and from above.";

constexpr const char* examples =
    "gaussmap view bunny.ply -o bunny.html              a page to look at it\n"
    "gaussmap view a.ply b.ply -o both.html             two side by side\n"
    "gaussmap view bunny.ply -o bunny.png               a picture\n"
    "gaussmap view scan.pcd --views 4 -o scan.png       a contact sheet\n"
    "gaussmap view part.stl --from 1,-2,1 -o part.png   seen from there\n"
    "gaussmap view torus.ply --field k1 -o torus.png    another value of the file";

/// `count` numbers with `between` between them, or nothing.
std::optional<std::vector<double>> numbers_of(const std::string& text, std::size_t count, char between) {
    std::vector<double> out;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (out.size() < count) {
        if (!out.empty() && (at == end || *at++ != between)) return {};
        double value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !std::isfinite(value)) return {};
        out.push_back(value);
        at = next;
    }
    if (at != end) return {};
    return out;
}

Check numbers(std::size_t count, const char* example) {
    return [=](const std::string& text) -> std::string {
        if (numbers_of(text, count, ',')) return "";
        return fmt::format("'{}' is not {} numbers as in {}", text, count, example);
    };
}

std::optional<std::array<int, 2>> size_of(const std::string& text) {
    const auto sides = numbers_of(text, 2, 'x');
    if (!sides) return {};
    for (const double side : *sides)
        if (side != std::floor(side) || side < 16 || side > 16384) return {};
    return std::array{static_cast<int>((*sides)[0]), static_cast<int>((*sides)[1])};
}

Check picture_size() {
    return [](const std::string& text) -> std::string {
        if (size_of(text)) return "";
        return fmt::format("'{}' is not a size as in 1600x1200, each 16 to 16384", text);
    };
}

Check one_or_four() {
    return [](const std::string& text) -> std::string {
        return text == "1" || text == "4" ? "" : fmt::format("'{}' is not 1 or 4", text);
    };
}

void declare(CommandLine& line, Options& o) {
    line.input(o.input, "IN", "A mesh or a cloud: " + gaussmap::known_extensions() + "; - is standard input");
    line.optional_input(o.second, "IN2", "Another, to compare with on a page");
    line.group("What");
    line.option("--field", o.field, "PROPERTY",
                "A property of the vertices (default: the total curvature, measured as gaussmap curvature does)");
    line.option("--as", o.as, "KIND", "auto, mesh or cloud. auto: a mesh if the file has faces (default: auto)",
                one_of({"auto", "mesh", "cloud"}));
    line.option("--range", o.range, "LOW,HIGH",
                "Values of the first and the last colour (default: 0 and the 98th percentile; from the 2nd where there "
                "are negative values)",
                numbers(2, "0,100"));
    line.group("Picture");
    line.option("--size", o.size, "WxH", "Pixels (default: 1600x1200)", picture_size());
    line.option("--views", o.picture.views, "N", "1, or 4: a contact sheet of quarter turns (default: 1)",
                one_or_four());
    line.option("--from", o.from, "X,Y,Z", "Where the eye is, from the middle of the object: a direction",
                numbers(3, "1,-2,1"));
    line.option("--up", o.up, "X,Y,Z", "The upward direction (default: z, or y for what is shortest along z)",
                numbers(3, "0,0,1"));
    o.outputs.geometries = false;
    o.outputs.pictures = o.outputs.pages = true;
    o.outputs.declare(line, true);
}

bool parallel(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    const auto squared = [](double x, double y, double z) { return x * x + y * y + z * z; };
    const double sine = squared(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    return sine <= 1e-11 * squared(a[0], a[1], a[2]) * squared(b[0], b[1], b[2]);
}

/// The options that are texts, and what does not go together. \throw Failure (wrong usage)
void interpret(Options& o) {
    if (!o.second.empty() && o.outputs.any_picture())
        throw Failure(Exit::wrong_usage, "two inputs stand side by side on a page; a .png shows one");
    if (o.input == "-" && o.second == "-")
        throw Failure(Exit::wrong_usage, "both inputs are standard input; name a file for one");
    const auto sides = size_of(o.size).value();
    o.picture.width = sides[0], o.picture.height = sides[1];
    const auto direction = [](const std::string& text, const char* name, std::array<double, 3>& out) {
        if (text.empty()) return;
        const std::vector<double> v = numbers_of(text, 3, ',').value();
        if (v[0] == 0 && v[1] == 0 && v[2] == 0)
            throw Failure(Exit::wrong_usage,
                          fmt::format("{}: '{}' is no direction; one number must not be 0", name, text));
        out = {v[0], v[1], v[2]};
    };
    direction(o.from, "--from", o.picture.direction);
    direction(o.up, "--up", o.picture.up);
    if (!o.from.empty() && !o.up.empty() && parallel(o.picture.direction, o.picture.up))
        throw Failure(Exit::wrong_usage, fmt::format("--up: '{}' is parallel to --from; give another", o.up));
    if (o.range.empty()) return;
    const std::vector<double> ends = numbers_of(o.range, 2, ',').value();
    if (ends[0] >= ends[1])
        throw Failure(Exit::wrong_usage, fmt::format("--range: '{}' is empty; the first must be less", o.range));
    o.picture.low = ends[0], o.picture.high = ends[1];
}

/// What is drawn.
struct Values {
    std::string name;
    std::vector<double> values, normals;
    std::vector<double> kappa;  ///< of the faces of a mesh that was measured
};

/// Sets the legend of a property: densities and curvatures as `shape` and `curvature` write them have a unit.
Values property_values(const Geometry& geometry, const std::string& path, Options& o) {
    const gaussmap::Property& property = vertex_property(geometry, o.field, path, "to draw");
    o.picture.label = o.field;
    const auto is_one_of = [&](const std::vector<std::string>& names) {
        return std::find(names.begin(), names.end(), o.field) != names.end();
    };
    o.picture.density = is_one_of({"scalar_total_curvature", "exact_density"});
    o.picture.diverging = is_one_of({"k1", "k2", "mean", "gaussian", "shape_index"});
    o.picture.unit = o.picture.density || is_one_of({"gaussian", "density_error"}) ? "1/unit²"
                     : is_one_of({"k1", "k2", "mean", "curvedness"})               ? "1/unit"
                                                                                   : "";
    return {o.field, property.as_double(), has_normals(geometry) ? geometry.normals : std::vector<double>(), {}};
}

Values measured_values(const Geometry& geometry, bool mesh, const Common& common) {
    const std::vector<double> none;
    const std::vector<double>& normals = has_normals(geometry) ? geometry.normals : none;
    Progress progress("measuring curvature", common.quiet);
    if (mesh) {
        gaussmap::MeshCurvatureOptions options;
        options.run = progress.run(common.threads);
        auto result = gaussmap::mesh_curvature(geometry.vertices, geometry.faces, normals, options);
        return {"total curvature", std::move(result.density), std::move(result.normals), std::move(result.kappa)};
    }
    gaussmap::CloudCurvatureOptions options;
    options.run = progress.run(common.threads);
    auto result = gaussmap::cloud_curvature(geometry.vertices, normals, options);
    return {"total curvature", std::move(result.density), std::move(result.normals), {}};
}

/// An input and what is shown on it.
struct Shown {
    std::string path;
    Geometry geometry;
    bool mesh = false;
    Values values;
};

Values values_of(const Shown& shown, Options& o, const Common& common) {
    if (!o.field.empty()) return property_values(shown.geometry, shown.path, o);
    return concerning(shown.path, [&] { return measured_values(shown.geometry, shown.mesh, common); });
}

void write_pages(const std::vector<Shown>& inputs, const Options& o, const Common& common) {
    std::vector<gaussmap::PageScene> scenes;
    for (const Shown& shown : inputs)
        concerning(shown.path, [&] {
            scenes.push_back(page_scene(shown.path, shown.geometry, shown.mesh, shown.values.normals));
            gaussmap::PageScene& scene = scenes.back();
            if (o.field.empty()) add_measured(scene, "density", shown.values.values);
            if (!shown.values.kappa.empty()) add_measured(scene, "kappa", shown.values.kappa, true);
            add_properties(scene, shown.geometry.vertex_properties, false);
            if (shown.mesh && shown.geometry.polygons.empty())
                add_properties(scene, shown.geometry.face_properties, true);
        });
    gaussmap::PageOptions options;
    options.field = o.field;
    options.low = o.picture.low, options.high = o.picture.high;
    options.direction = o.picture.direction, options.up = o.picture.up;
    write_pages(o.outputs, scenes, options, common);
}

Table table_of(const Json& report) {
    Table table;
    table.add("field", report["field"].get<std::string>());
    table.add("undefined", count(report["undefined"].get<std::size_t>(), "value", "values"));
    if (!report["width"].is_null()) {
        table.add("colours", fmt::format("from {} to {}", number(report["low"]), number(report["high"])));
        table.add("picture", fmt::format("{} × {} pixels, {}", report["width"].get<int>(), report["height"].get<int>(),
                                         count(report["views"].get<std::size_t>(), "view", "views")));
    }
    add_ending(table, report);
    return table;
}

/// What is known of an input.
Json report_of(const Shown& shown) {
    Json report = {{"kind", shown.mesh ? "mesh" : "cloud"}, {"file", shown.path}};
    report["vertices"] = shown.geometry.vertex_count();
    report["faces"] = shown.geometry.face_count();
    report["field"] = shown.values.name;
    report["undefined"] = std::count_if(shown.values.values.begin(), shown.values.values.end(),
                                        [](double value) { return !std::isfinite(value); });
    return report;
}

}  // namespace

void view(int argc, char** argv) {
    Options o;
    CommandLine line("view IN [IN2] -o OUT… [options]", about, examples);
    declare(line, o);
    if (!line.parse(argc, argv)) return;
    o.outputs.check(line);
    interpret(o);

    Stopwatch watch;
    double seconds_read = 0, seconds_values = 0;
    std::vector<Shown> inputs;
    for (const std::string& path : {o.input, o.second}) {
        if (path.empty()) continue;
        Shown shown = {path, read_input(path, line.common), false, {}};
        seconds_read += watch.lap();
        shown.mesh = taken_as_mesh(o.as, shown.geometry, path);
        shown.values = values_of(shown, o, line.common);
        seconds_values += watch.lap();
        inputs.push_back(std::move(shown));
    }
    const Shown& first = inputs.front();
    Json report = report_of(first);
    if (inputs.size() > 1) report["second"] = report_of(inputs.back());
    for (const char* key : {"low", "high", "width", "height", "views"}) report[key] = Json();
    if (o.outputs.any_picture()) {
        const gaussmap::Picture picture = concerning(o.input, [&] {
            return draw_pictures(o.outputs, first.geometry, first.mesh, first.values.values, first.values.normals,
                                 o.picture, line.common);
        });
        report["low"] = picture.low;
        report["high"] = picture.high;
        report["width"] = picture.width;
        report["height"] = picture.height;
        report["views"] = o.picture.views;
    }
    if (o.outputs.any_page()) write_pages(inputs, o, line.common);
    report["threads"] = line.common.threads;
    report["seconds"] = {
        {"read", seconds_read}, {"values", seconds_values}, {"draw", watch.lap()}, {"total", watch.total()}};
    report["peak_bytes"] = peak_bytes();
    report["outputs"] = o.outputs.paths;
    report["notes"] = first.geometry.notes;
    if (inputs.size() > 1)
        for (const std::string& note : inputs.back().geometry.notes) report["notes"].push_back(note);
    present(report, o.input, table_of(report), line.common);
}

}  // namespace cli
