// What a web worker calls: a verb of the command line, on files in the memory of the module, and the arrays of a file
// that a viewer draws. Plain C, so that no glue of its own is needed.
#include <emscripten/emscripten.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "camera.h"
#include "gaussmap/io.h"
#include "outcome.h"
#include "report.h"
#include "verbs.h"

namespace {

using cli::Json;
using gaussmap::Geometry;
using gaussmap::Property;

void dispatch(int argc, char** argv) {
    const std::string_view verb = argv[1];
    if (verb == "curvature") return cli::curvature(argc, argv);
    if (verb == "decimate") return cli::decimate(argc, argv);
    throw cli::Failure(cli::Exit::wrong_usage, "the page knows no verb '" + std::string(verb) + "'");
}

/// The file that is drawn, until the next one.
struct Shown {
    Geometry geometry;
    std::vector<std::vector<double>> values;
};
Shown shown;

template <class Number>
Json place_of(const std::vector<Number>& array) {
    return {{"at", reinterpret_cast<std::uintptr_t>(array.data())}, {"length", array.size()}};
}

void add_field(Json& fields, const std::vector<Property>& properties, const char* name, bool of_faces) {
    for (const Property& property : properties) {
        if (property.name != name || property.list) continue;
        fields.push_back({{"name", name},
                          {"ofFaces", of_faces},
                          {"values", place_of(shown.values.emplace_back(property.as_double()))}});
    }
}

/// Sides of the box of the finite vertices.
gaussmap::Vec3 sides_of(const std::vector<double>& vertices) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (!std::isfinite(vertices[i])) continue;
        low[i % 3] = std::min(low[i % 3], vertices[i]);
        high[i % 3] = std::max(high[i % 3], vertices[i]);
    }
    return {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
}

Json triple(gaussmap::Vec3 v) {
    return std::array{v.x, v.y, v.z};
}

std::string text;

}  // namespace

extern "C" {

/// Run a verb; arguments by lines, the verb first. Returns the exit code; the report is on standard output.
EMSCRIPTEN_KEEPALIVE int gaussmap_run(const char* lines) {
    std::vector<std::string> words = {"gaussmap"};
    for (std::string_view rest = lines; !rest.empty();) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        words.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (words.size() < 2) return static_cast<int>(cli::Exit::wrong_usage);
    return static_cast<int>(cli::outcome_of(dispatch, static_cast<int>(words.size()), argv.data()));
}

/// What a viewer draws of a file that a verb wrote: JSON with the places of its arrays, which stay until the next call.
/// {"error": …} where it cannot be read.
EMSCRIPTEN_KEEPALIVE const char* gaussmap_scene(const char* path) {
    shown = {};
    Json scene;
    try {
        shown.geometry = gaussmap::read(path);
        const Geometry& geometry = shown.geometry;
        shown.values.reserve(2);  // the places of the first must stay
        const gaussmap::View view = gaussmap::views_of(sides_of(geometry.vertices), {}).front();
        scene["positions"] = place_of(geometry.vertices);
        scene["triangles"] = place_of(geometry.faces);
        scene["normals"] = place_of(geometry.normals);
        scene["toward"] = triple(view.toward);
        scene["up"] = triple(view.up);
        scene["fields"] = Json::array();
        add_field(scene["fields"], geometry.vertex_properties, "scalar_total_curvature", false);
        add_field(scene["fields"], geometry.face_properties, "kappa", true);
    } catch (const std::exception& error) { scene = {{"error", error.what()}}; }
    text = scene.dump();
    return text.c_str();
}
}
