// gaussmap shape: analytic surfaces with exact normals and curvature, to test and to compare with.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "files.h"
#include "gaussmap/surfaces.h"
#include "pictures.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Surface;
using gaussmap::SurfaceOptions;

/// The numbers of a shape by the name of their option; a grid is "around" and "across", axes are "a", "b" and "c".
struct Values {
    std::map<std::string, double> numbers;

    double operator[](const char* name) const { return numbers.at(name); }
    int whole(const char* name) const { return static_cast<int>(numbers.at(name)); }
    int around() const { return whole("around"); }
    int across() const { return whole("across"); }
};

struct Shape {
    const char* name;
    const char* about;
    std::map<std::string, double> defaults;
    Surface (*make)(const Values&, const SurfaceOptions&);
};

const std::vector<Shape>& shapes() {
    using V = Values;
    using O = SurfaceOptions;
    using namespace gaussmap;
    static const std::vector<Shape> table = {
        {"sphere",
         "a subdivided icosahedron",
         {{"subdivisions", 5}, {"radius", 1}},
         [](const V& v, const O& o) { return gaussmap::sphere(v.whole("subdivisions"), v["radius"], o); }},
        {"torus",
         "of revolution about z",
         {{"major", 1}, {"minor", 0.5}, {"around", 36}, {"across", 36}},
         [](const V& v, const O& o) { return torus(v["major"], v["minor"], v.around(), v.across(), o); }},
        {"knot",
         "tube around a torus knot",
         {{"p", 2}, {"q", 3}, {"radius", 0.25}, {"major", 2}, {"minor", 1}, {"around", 400}, {"across", 40}},
         [](const V& v, const O& o) {
             return torus_knot(v.whole("p"), v.whole("q"), v["major"], v["minor"], v["radius"], v.around(), v.across(),
                               o);
         }},
        {"figure-eight",
         "tube around the figure-eight knot",
         {{"radius", 0.25}, {"scale", 1}, {"around", 400}, {"across", 40}},
         [](const V& v, const O& o) { return figure_eight_knot(v["scale"], v["radius"], v.around(), v.across(), o); }},
        {"ellipsoid",
         "a stretched sphere",
         {{"a", 1}, {"b", 0.8}, {"c", 0.6}, {"subdivisions", 5}},
         [](const V& v, const O& o) { return ellipsoid(v["a"], v["b"], v["c"], v.whole("subdivisions"), o); }},
        {"bumpy",
         "a sphere with smooth bumps",
         {{"radius", 1}, {"amplitude", 0.1}, {"frequency", 4}, {"subdivisions", 6}},
         [](const V& v, const O& o) {
             return bumpy_sphere(v["radius"], v["amplitude"], v["frequency"], v.whole("subdivisions"), o);
         }},
        {"catenoid",
         "a minimal surface, open; radius is its neck's",
         {{"radius", 1}, {"height", 2}, {"around", 72}, {"across", 36}},
         [](const V& v, const O& o) { return catenoid(v["radius"], v["height"], v.around(), v.across(), o); }},
        {"cylinder",
         "about z, open",
         {{"radius", 1}, {"height", 2}, {"around", 72}, {"across", 36}},
         [](const V& v, const O& o) { return cylinder(v["radius"], v["height"], v.around(), v.across(), o); }},
        {"plane",
         "a rectangle",
         {{"width", 1}, {"depth", 1}, {"around", 36}, {"across", 36}},
         [](const V& v, const O& o) { return plane(v["width"], v["depth"], v.around(), v.across(), o); }},
        {"waves",
         "an egg-box of cosines over a rectangle",
         {{"width", 1}, {"depth", 1}, {"amplitude", 0.05}, {"wavelength", 0.5}, {"around", 100}, {"across", 100}},
         [](const V& v, const O& o) {
             return waves(v["width"], v["depth"], v["amplitude"], v["wavelength"], v.around(), v.across(), o);
         }},
    };
    return table;
}

const Shape& shape_named(const std::string& name) {
    std::vector<std::string> names;
    for (const Shape& shape : shapes()) {
        if (name == shape.name) return shape;
        names.push_back(shape.name);
    }
    throw Failure(Exit::wrong_usage, fmt::format("shape: '{}' is not one of {}{}", name, fmt::join(names, ", "),
                                                 did_you_mean(name, names)));
}

/// An option that some shapes have.
struct ShapeOption {
    const char* name;
    const char* value_name;
    const char* about;
    std::vector<const char*> numbers;  ///< what it gives
    bool whole;
    char between;  ///< its numbers
};

const std::vector<ShapeOption>& shape_options() {
    static const std::vector<ShapeOption> table = {
        {"subdivisions",
         "N",
         "Times the faces of an icosahedron are split in four, 0 to 12",
         {"subdivisions"},
         true,
         0},
        {"grid",
         "AxB",
         "Vertices around (or along) by vertices across, each 3 or more",
         {"around", "across"},
         true,
         'x'},
        {"radius", "R", "Of the sphere, the cylinder, the neck, the tube of a knot", {"radius"}, false, 0},
        {"major", "R", "From the axis to the centre of the tube", {"major"}, false, 0},
        {"minor", "R", "Of the tube; of the torus that a knot winds on", {"minor"}, false, 0},
        {"p", "N", "Times the knot winds about the axis", {"p"}, true, 0},
        {"q", "N", "Times it winds about the tube; no factor in common with p", {"q"}, true, 0},
        {"scale", "S", "Of the figure-eight curve, which is about 6 wide", {"scale"}, false, 0},
        {"axes", "A,B,C", "Half axes", {"a", "b", "c"}, false, ','},
        {"amplitude", "H", "Of waves; of bumps, as a fraction of the radius", {"amplitude"}, false, 0},
        {"frequency", "F", "Of bumps", {"frequency"}, false, 0},
        {"wavelength", "L", "Of waves", {"wavelength"}, false, 0},
        {"width", "W", "Along x", {"width"}, false, 0},
        {"depth", "D", "Along y", {"depth"}, false, 0},
        {"height", "H", "Along z", {"height"}, false, 0},
    };
    return table;
}

bool has(const Shape& shape, const ShapeOption& option) {
    return shape.defaults.contains(option.numbers.front());
}

std::string options_of(const Shape& shape) {
    std::vector<std::string> names;
    for (const ShapeOption& option : shape_options())
        if (has(shape, option)) names.push_back(fmt::format("--{}", option.name));
    return fmt::format("{}", fmt::join(names, ", "));
}

/// The numbers of an option's value, which must be as many as it gives.
bool parse(const ShapeOption& option, const std::string& text, std::vector<double>& numbers) {
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < option.numbers.size(); ++i) {
        if (i > 0 && (at == end || *at++ != option.between)) return false;
        double value = 0;
        int whole = 0;
        const auto [next, error] = option.whole ? std::from_chars(at, end, whole) : std::from_chars(at, end, value);
        if (error != std::errc()) return false;
        numbers.push_back(option.whole ? whole : value);
        at = next;
    }
    return at == end;
}

Check value_of(const ShapeOption& option) {
    return [&option](const std::string& text) -> std::string {
        std::vector<double> ignored;
        if (parse(option, text, ignored)) return "";
        const char* kind = option.whole ? "whole number" : "number";
        return option.between
                   ? fmt::format("'{}' is not {} {}s as in {}", text, option.numbers.size(), kind, option.value_name)
                   : fmt::format("'{}' is not a {}", text, kind);
    };
}

struct Options {
    std::string name;
    std::map<std::string, std::string> texts;  ///< of the shape's options, as typed
    SurfaceOptions surface;
    std::string noise_unit = "edge";
    Outputs outputs;
};

constexpr const char* about =
    "Makes a triangle mesh of an analytic surface. Its vertices carry the exact unit normals (nx ny nz), the exact "
    "principal curvatures k1 ≥ k2 (1/length) and exact_density = k1² + k2² (1/length²), all as float64.";

/// "--major 1 --minor 0.5 --grid 36x36"
std::string defaults_of(const Shape& shape) {
    std::string text;
    for (const ShapeOption& option : shape_options()) {
        if (!has(shape, option)) continue;
        text += fmt::format("{}--{} ", text.empty() ? "" : " ", option.name);
        for (std::size_t i = 0; i < option.numbers.size(); ++i) {
            if (i > 0) text += option.between;
            text += fmt::format("{}", Values{shape.defaults}[option.numbers[i]]);
        }
    }
    return text;
}

std::string help_of_names() {
    std::string text = "The surface. Each has these options, shown with what they are unless given:";
    for (const Shape& shape : shapes())
        text += fmt::format("\n{} ({}): {}", shape.name, shape.about, defaults_of(shape));
    return text;
}

constexpr const char* examples =
    "gaussmap shape sphere --subdivisions 5 -o sphere.ply\n"
    "gaussmap shape torus --major 1 --minor 0.5 --grid 36x36 -o torus.ply\n"
    "gaussmap shape knot --p 2 --q 3 --radius 0.3 --grid 800x60 -o knot.ply\n"
    "gaussmap shape torus --grid 90x45 --jitter 0.25 --noise 0.02 --seed 7 -o t.ply";

void declare(CommandLine& line, Options& o) {
    line.input(o.name, "NAME", help_of_names());
    line.group("Surface (lengths in the unit you like)");
    for (const ShapeOption& option : shape_options())
        line.option(fmt::format("--{}", option.name), o.texts[option.name], option.value_name, option.about,
                    value_of(option));
    line.group("Irregularity");
    line.option(
        "--jitter", o.surface.jitter, "F",
        "Move vertices on the surface by up to this fraction of the edge length; 0.25 is irregular (default: 0)",
        number_of_at_least_zero());
    line.option(
        "--noise", o.surface.noise, "F",
        "Then move them off it: Gaussian in each coordinate, its standard deviation as a fraction of --noise-unit. "
        "Normals and curvature stay those of the clean surface (default: 0)",
        number_of_at_least_zero());
    line.option("--noise-unit", o.noise_unit, "U",
                "edge: the mean edge length\ndiagonal: the diagonal of the bounding box (default: edge)",
                one_of({"edge", "diagonal"}));
    line.option("--seed", line.common.seed, "N", "Of jitter and noise; the same seed makes the same file (default: 0)",
                whole_number(0, INT64_MAX));
    o.outputs.pictures = true;
    o.outputs.declare(line, true);
}

/// Defaults, and over them what was typed. \throw Failure (wrong usage) on an option that the shape does not have.
Values values_of(const Shape& shape, const Options& o, const CommandLine& line) {
    Values values{shape.defaults};
    for (const ShapeOption& option : shape_options()) {
        if (!line.given(fmt::format("--{}", option.name))) continue;
        if (!has(shape, option))
            throw Failure(Exit::wrong_usage,
                          fmt::format("shape {}: has no --{}; it has {}", shape.name, option.name, options_of(shape)));
        std::vector<double> numbers;
        parse(option, o.texts.at(option.name), numbers);
        for (std::size_t i = 0; i < numbers.size(); ++i) values.numbers[option.numbers[i]] = numbers[i];
    }
    return values;
}

Surface make(const Shape& shape, const Values& values, const SurfaceOptions& options) {
    try {
        return shape.make(values, options);
    } catch (const std::invalid_argument& error) {
        throw Failure(Exit::wrong_usage, fmt::format("shape: {}", error.what()));
    }
}

gaussmap::Geometry geometry_of(Surface surface) {
    using gaussmap::Type;
    gaussmap::Geometry out;
    out.vertex_type = out.normal_type = Type::float64;
    out.vertex_properties = {make_property("exact_density", surface.density, Type::float64),
                             make_property("k1", surface.k1, Type::float64),
                             make_property("k2", surface.k2, Type::float64)};
    out.vertices = std::move(surface.vertices);
    out.faces = std::move(surface.faces);
    out.normals = std::move(surface.normals);
    return out;
}

Json parameters(const Shape& shape, const Values& values, const SurfaceOptions& options) {
    Json out = Json::object();
    for (const ShapeOption& option : shape_options()) {
        if (!has(shape, option)) continue;
        for (const char* name : option.numbers)
            out[name] = option.whole ? Json(values.whole(name)) : Json(values[name]);
    }
    out["jitter"] = options.jitter;
    out["noise"] = options.noise;
    out["noise_unit"] = options.noise_unit == gaussmap::NoiseUnit::edge ? "edge" : "diagonal";
    out["seed"] = options.seed;
    return out;
}

}  // namespace

void shape(int argc, char** argv) {
    Options o;
    CommandLine line("shape NAME -o OUT… [options]", about, examples);
    declare(line, o);
    if (!line.parse(argc, argv)) return;
    const Shape& chosen = shape_named(o.name);
    const Values values = values_of(chosen, o, line);
    o.outputs.check(line);
    o.surface.seed = line.common.seed;
    o.surface.noise_unit = o.noise_unit == "edge" ? gaussmap::NoiseUnit::edge : gaussmap::NoiseUnit::diagonal;

    Stopwatch watch;
    const gaussmap::Geometry geometry = geometry_of(make(chosen, values, o.surface));
    const double making = watch.lap();
    o.outputs.write(geometry);
    if (o.outputs.any_picture())
        draw_pictures(o.outputs, geometry, true, geometry.vertex_property("exact_density")->as_double(),
                      geometry.normals, {}, line.common);

    Json report = {{"name", o.name}, {"vertices", geometry.vertex_count()}, {"faces", geometry.face_count()}};
    report["parameters"] = parameters(chosen, values, o.surface);
    report["seconds"] = {{"make", making}, {"write", watch.lap()}, {"total", watch.total()}};
    report["peak_bytes"] = peak_bytes();
    report["outputs"] = o.outputs.paths;
    report["notes"] = o.outputs.losses(geometry);
    Table table;
    table.add("made", count(geometry.vertex_count(), "vertex", "vertices") + ", " +
                          count(geometry.face_count(), "face", "faces"));
    std::string words;
    for (const auto& [name, value] : report["parameters"].items())
        words += fmt::format("{}{} {}", words.empty() ? "" : ", ", name,
                             value.is_string() ? value.get<std::string>() : number(value));
    table.add("with", words);
    for (const std::string& path : o.outputs.paths) table.add("wrote", path);
    present(report, o.name, table, line.common);
}

}  // namespace cli
