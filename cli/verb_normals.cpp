// gaussmap normals: unit normals of a mesh, or of a cloud, oriented.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "files.h"
#include "gaussmap/normals.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Geometry;

struct Options {
    std::string input;
    Outputs outputs;
    std::string as = "auto", method, orient = "mst";
    int k = 20, degree = 4;
};

constexpr const char* about =
    "Estimates unit normals and writes them into the file (nx ny nz in PLY), in place of those it had. On a mesh a "
    "vertex takes the weighted normals of its faces. On a cloud a surface is fitted to the nearest neighbours of each "
    "point; the sign is then carried along a spanning tree, each connected part starting at its highest point, up. "
    "Where nothing defines a normal (a vertex of no face, neighbours on a line) it is NaN; the report counts these.";

constexpr const char* examples =
    "gaussmap normals scan.pcd -o scan.ply              a cloud, oriented\n"
    "gaussmap normals scan.xyz -o out.ply --method pca  fitted planes\n"
    "gaussmap normals bunny.obj -o bunny.ply            a mesh: weights of Max 1999";

void declare(CommandLine& line, Options& o) {
    line.input(o.input, "IN", "A mesh or a cloud: " + gaussmap::known_extensions() + "; - is standard input");
    line.group("Method");
    line.option("--as", o.as, "KIND", "auto, mesh or cloud. auto: a mesh if the file has faces (default: auto)",
                one_of({"auto", "mesh", "cloud"}));
    line.option("--method", o.method, "M",
                "max, angle, area: meshes; weights of the faces around a vertex (default: max)\n"
                "jet, pca, wpca: clouds; a fitted polynomial, a fitted plane, the same with near points weighing more "
                "(default: jet)",
                one_of({"max", "angle", "area", "jet", "pca", "wpca"}));
    line.group("Clouds");
    line.option("--k", o.k, "N", "Nearest neighbours a point, 3 to 1000 (default: 20)", whole_number(3, 1000));
    line.option("--degree", o.degree, "N", "Degree of the jet, 1 to 4 (default: 4)", whole_number(1, 4));
    line.option("--orient", o.orient, "O",
                "mst: agreeing signs along a spanning tree\nnone: signs as the fit left them (default: mst)",
                one_of({"mst", "none"}));
    o.outputs.declare(line, true);
}

void choose_method(Options& o, bool mesh) {
    if (o.method.empty()) o.method = mesh ? "max" : "jet";
    const bool of_clouds = o.method == "jet" || o.method == "pca" || o.method == "wpca";
    if (mesh && of_clouds)
        throw Failure(Exit::wrong_usage, fmt::format("--method {} is for clouds and {} is a mesh; use max, angle or "
                                                     "area, or --as cloud",
                                                     o.method, o.input));
    if (!mesh && !of_clouds)
        throw Failure(Exit::wrong_usage,
                      fmt::format("--method {} is for meshes and {} is taken as a cloud; use jet, pca or wpca",
                                  o.method, o.input));
}

/// Normals of the faces' vertices, and the counts.
Json estimate_on_mesh(Geometry& geometry, const Options& o, const gaussmap::Execution& run) {
    using gaussmap::NormalWeights;
    const NormalWeights weights = o.method == "angle"  ? NormalWeights::angle
                                  : o.method == "area" ? NormalWeights::area
                                                       : NormalWeights::max;
    Stopwatch watch;
    geometry.normals = gaussmap::mesh_normals(geometry.vertices, geometry.faces, weights, run);
    return {{"seconds", {{"neighbors", 0.0}, {"normals", watch.lap()}, {"orient", 0.0}}}};
}

/// Normals of the distinct points, handed to every point at the position of one; and the counts.
Json estimate_on_cloud(Geometry& geometry, const Options& o, const gaussmap::Execution& run) {
    Stopwatch watch;
    const gaussmap::DistinctPoints distinct = gaussmap::distinct_points(geometry.vertices);
    const gaussmap::Neighbors neighbors = gaussmap::nearest_neighbors(distinct.points, o.k, run);
    const double seconds_neighbors = watch.lap();
    using gaussmap::CloudNormals;
    const CloudNormals method = o.method == "pca"    ? CloudNormals::pca
                                : o.method == "wpca" ? CloudNormals::weighted_pca
                                                     : CloudNormals::jet;
    auto fitted = gaussmap::cloud_normals(distinct.points, neighbors, {method, o.degree, run});
    const double seconds_normals = watch.lap();
    if (o.orient == "mst") gaussmap::orient_normals(distinct.points, neighbors, fitted.normals, run);
    geometry.normals.assign(geometry.vertices.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < distinct.target.size(); ++i)
        if (distinct.target[i] >= 0) std::copy_n(&fitted.normals[3 * distinct.target[i]], 3, &geometry.normals[3 * i]);
    return {{"lowered", fitted.lowered},
            {"duplicates", distinct.duplicates},
            {"non_finite", distinct.non_finite},
            {"seconds", {{"neighbors", seconds_neighbors}, {"normals", seconds_normals}, {"orient", watch.lap()}}}};
}

std::size_t undefined(const std::vector<double>& normals) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < normals.size(); i += 3) n += std::isnan(normals[i]);
    return n;
}

Table table_of(const Json& report) {
    const bool mesh = report["kind"] == "mesh";
    const char *const one = mesh ? "vertex" : "point", *const many = mesh ? "vertices" : "points";
    const auto n = [&](const char* key) { return count(report[key].get<std::size_t>(), one, many); };
    Table table;
    table.add("read", n("vertices") + ", " + count(report["faces"].get<std::size_t>(), "face", "faces"));
    table.add("method", report["method"].get<std::string>());
    if (!mesh) {
        table.add("neighbours", number(report["k"]));
        table.add("orient", report["orient"].get<std::string>());
        table.add("duplicate", n("duplicates") + " at the position of an earlier one");
        table.add("non-finite", n("non_finite"));
        table.add("lower degree", n("lowered"));
    }
    table.add("undefined", n("undefined"));
    add_ending(table, report);
    return table;
}

}  // namespace

void normals(int argc, char** argv) {
    Options o;
    CommandLine line("normals IN -o OUT… [options]", about, examples);
    declare(line, o);
    if (!line.parse(argc, argv)) return;
    o.outputs.check(line);

    Stopwatch watch;
    Geometry geometry = read_input(o.input, line.common);
    const double reading = watch.lap();
    const bool mesh = taken_as_mesh(o.as, geometry, o.input);
    choose_method(o, mesh);
    o.outputs.check_fit(geometry);
    if (geometry.normals.empty()) geometry.normal_type = geometry.vertex_type;
    Json found = concerning(o.input, [&] {
        Progress progress("estimating normals", line.common.quiet);
        const gaussmap::Execution run = progress.run(line.common.threads);
        return mesh ? estimate_on_mesh(geometry, o, run) : estimate_on_cloud(geometry, o, run);
    });

    Json report = {{"kind", mesh ? "mesh" : "cloud"}, {"file", o.input}};
    report["vertices"] = geometry.vertex_count();
    report["faces"] = geometry.face_count();
    report["method"] = o.method == "jet" ? fmt::format("jet {}", o.degree) : o.method;
    report["k"] = mesh ? Json() : Json(o.k);
    report["orient"] = mesh ? Json() : Json(o.orient);
    report["threads"] = line.common.threads;
    report["undefined"] = undefined(geometry.normals);
    report.update(found);
    watch.lap();
    o.outputs.write(geometry);
    report["seconds"]["read"] = reading;
    report["seconds"]["write"] = watch.lap();
    report["seconds"]["total"] = watch.total();
    report_written(report, o.outputs, geometry);
    present(report, o.input + ": normals", table_of(report), line.common);
}

}  // namespace cli
