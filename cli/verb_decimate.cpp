// gaussmap decimate: fewer triangles for the same surface.
#include <fmt/format.h>

#include "carried_values.h"
#include "files.h"
#include "gaussmap/decimate.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Decimation;
using gaussmap::DecimationMethod;
using gaussmap::DecimationObjective;
using gaussmap::Geometry;

struct Options {
    std::string input;
    Outputs outputs;
    std::size_t faces = 0;
    double ratio = 0, error = 0, feature_angle = 180;
    std::string method = "best", objective = "both", weight = "curvature";
    bool fast = false, preserve_boundary = false, lock_border = false, allow_topology = false, weld = false;
};

constexpr const char* about =
    "Fewer triangles for the same surface, features kept. What comes out is as valid as what went in: no triangle "
    "turned over, no side with a further triangle, no degenerate triangle, parts, handles and holes kept. Normals, "
    "colours, "
    "texture coordinates and other values are carried over, seams of texture coordinates kept. Non-manifold, open and "
    "duplicated input is taken as it is. Where no valid step is left before the target, the report says why.\n\n"
    "The error that is reported is the larger of both ways, over the diagonal of the input's box, as compare measures "
    "it; --error E promises it, proven.";

constexpr const char* examples =
    "gaussmap decimate bunny.ply -o small.ply --faces 5000\n"
    "gaussmap decimate bunny.ply -o small.ply --ratio 0.1  a tenth of it\n"
    "gaussmap decimate bunny.ply -o small.ply --error 0.001\n"
    "                                                  Hausdorff distance at most\n"
    "                                                  0.1 % of the box's diagonal\n"
    "gaussmap decimate scan.stl -o small.stl --ratio 0.05 --fast";

void declare(CommandLine& line, Options& o) {
    line.input(o.input, "IN", "A mesh: " + gaussmap::known_extensions() + "; - is standard input");
    line.group("Target (one of them)");
    line.option("--faces", o.faces, "N", "At most this many triangles", whole_number(1, 2147483647));
    line.option("--ratio", o.ratio, "R", "This part of the triangles, above 0 and at most 1", positive_number());
    line.option("--error", o.error, "E",
                "As few triangles as are found with a two-sided Hausdorff distance of at most E, over the diagonal of "
                "the box; proven, and some ten times the work",
                positive_number());
    line.group("Method");
    line.option("--method", o.method, "M",
                "best: collapses, then a fit to the original\nqem: quadric error metric\nedge: shortest edge first, to "
                "its midpoint (default: best)",
                one_of({"best", "qem", "edge"}));
    line.option("--objective", o.objective, "O", "Which distance best makes small: rms, max or both (default: both)",
                one_of({"rms", "max", "both"}));
    line.option("--weight", o.weight, "W",
                "curvature: costs weigh by the total curvature; none: they do not (default: curvature)",
                one_of({"curvature", "none"}));
    line.flag("--fast", o.fast, "best without the fit: several times faster, less near");
    line.group("What is kept");
    line.flag("--preserve-boundary", o.preserve_boundary, "Borders hold a thousand times firmer than the surface");
    line.flag("--lock-border", o.lock_border, "No vertex of a border, seam or feature moves or goes");
    line.option("--feature-angle", o.feature_angle, "A",
                "Edges bent by more than A degrees are features, along which collapses run (default: none)",
                positive_number());
    line.flag("--allow-topology", o.allow_topology, "Holes and slits may close");
    line.flag("--weld", o.weld, "First join vertices at exactly the same position");
    o.outputs.declare(line, true);
}

void check(const CommandLine& line, const Options& o) {
    const int targets = line.given("--faces") + line.given("--ratio") + line.given("--error");
    if (targets != 1)
        throw Failure(Exit::wrong_usage, targets == 0 ? "decimate: a target is missing; give --faces N, --ratio R or "
                                                        "--error E"
                                                      : "decimate: --faces, --ratio and --error exclude each other");
    if (o.ratio > 1) throw Failure(Exit::wrong_usage, fmt::format("--ratio: '{}' is more than 1", o.ratio));
    if (o.feature_angle > 180)
        throw Failure(Exit::wrong_usage, fmt::format("--feature-angle: '{}' is more than 180", o.feature_angle));
    for (const char* option : {"--objective", "--fast"})
        if (o.method != "best" && line.given(option))
            throw Failure(Exit::wrong_usage,
                          fmt::format("{} is for --method best, and the method is {}", option, o.method));
}

std::size_t faces_wanted(const Options& o, const Geometry& geometry) {
    return o.ratio > 0 ? static_cast<std::size_t>(o.ratio * static_cast<double>(geometry.face_count())) : o.faces;
}

gaussmap::DecimateOptions plan(const Options& o, const Geometry& geometry, const gaussmap::Execution& run) {
    gaussmap::DecimateOptions options;
    options.faces = faces_wanted(o, geometry);
    options.error = o.error;
    options.method = o.method == "qem"    ? DecimationMethod::qem
                     : o.method == "edge" ? DecimationMethod::edge
                                          : DecimationMethod::best;
    options.objective = o.objective == "rms"   ? DecimationObjective::rms
                        : o.objective == "max" ? DecimationObjective::max
                                               : DecimationObjective::both;
    options.weights = o.weight == "curvature";
    options.fast = o.fast;
    options.preserve_boundary = o.preserve_boundary;
    options.lock_border = o.lock_border;
    options.feature_angle = o.feature_angle;
    options.allow_topology = o.allow_topology;
    options.seams = texture_seams(geometry);
    options.measure = true;
    options.sources = has_values_to_carry(geometry);
    options.run = run;
    return options;
}

/// Why the target was not reached, for a person.
std::string reason(const Decimation& made) {
    std::vector<std::string> parts;
    const auto add = [&](std::size_t n, const char* why) {
        if (n > 0) parts.push_back(fmt::format("{} {}", count(n, "edge", "edges"), why));
    };
    add(made.refused_locked, "held by borders, seams, features or non-manifold vertices");
    add(made.refused_topology, "that would change the topology");
    add(made.refused_folding, "that would fold the surface");
    return fmt::format("no valid collapse is left: {}", fmt::join(parts, ", "));
}

/// {max, rms, bound}: both ways, over the diagonal.
Json error_of(const Decimation& made) {
    const bool any = !made.faces.empty();
    return {{"max", any ? Json(made.max_error) : Json()},
            {"rms", any ? Json(made.rms_error) : Json()},
            {"bound", made.error_bound > 0 ? Json(made.error_bound) : Json()}};
}

Table table_of(const Json& report) {
    Table table;
    const auto n = [&](const char* key, const char* one, const char* many) {
        return count(report[key].get<std::size_t>(), one, many);
    };
    table.add("read", n("vertices_in", "vertex", "vertices") + ", " + n("faces_in", "triangle", "triangles"));
    table.add("kept", n("vertices_out", "vertex", "vertices") + ", " + n("faces_out", "triangle", "triangles"));
    if (!report["reason"].is_null()) table.add("stopped", report["reason"].get<std::string>());
    const Json& error = report["error"];
    if (!error["max"].is_null())
        table.add("distance", fmt::format("max {:.3g}, RMS {:.3g} of the diagonal", error["max"].get<double>(),
                                          error["rms"].get<double>()));
    if (!error["bound"].is_null())
        table.add("proven", fmt::format("at most {:.4g} of the diagonal", error["bound"].get<double>()));
    add_ending(table, report);
    return table;
}

}  // namespace

void decimate(int argc, char** argv) {
    Options o;
    CommandLine line("decimate IN -o OUT… --faces N|--ratio R|--error E [options]", about, examples);
    declare(line, o);
    if (!line.parse(argc, argv)) return;
    check(line, o);
    o.outputs.check(line);

    Stopwatch watch;
    Geometry geometry = read_input(o.input, line.common);
    const double reading = watch.lap();
    if (geometry.faces.empty()) throw Failure(Exit::bad_input, o.input + ": holds no faces; decimate takes a mesh");
    if (o.weld) geometry = gaussmap::weld(geometry);
    geometry = gaussmap::triangulate(geometry);
    o.outputs.check_fit(geometry);

    Json report = {{"kind", "mesh"}, {"file", o.input}};
    report["vertices_in"] = geometry.vertex_count();
    report["faces_in"] = geometry.face_count();
    watch.lap();
    const Decimation made = concerning(o.input, [&] {
        Progress progress("decimating", line.common.quiet);
        return gaussmap::decimate(geometry.vertices, geometry.faces,
                                  plan(o, geometry, progress.run(line.common.threads)));
    });
    Geometry after = carried_over(geometry, made);
    const double decimating = watch.lap() - made.seconds_measure;

    report["faces_out"] = after.face_count();
    report["vertices_out"] = after.vertex_count();
    report["method"] = o.method;
    report["target"] = o.error > 0 ? Json() : Json(faces_wanted(o, geometry));
    const bool reached = made.stop == gaussmap::DecimationStop::target;
    report["reached"] = reached;
    report["reason"] = reached ? Json() : Json(reason(made));
    report["degenerate"] = made.degenerate;
    report["non_finite"] = made.non_finite;
    report["error"] = error_of(made);
    report["threads"] = line.common.threads;
    o.outputs.write(after);
    report["seconds"] = {{"read", reading},        {"collapse", made.seconds_collapse}, {"fit", made.seconds_fit},
                         {"decimate", decimating}, {"measure", made.seconds_measure},   {"write", watch.lap()}};
    report["seconds"]["total"] = watch.total();
    report_written(report, o.outputs, after);
    present(report, o.input + ": decimation", table_of(report), line.common);
}

}  // namespace cli
