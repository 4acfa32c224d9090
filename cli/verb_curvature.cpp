// gaussmap curvature: total curvature of a mesh (vertices and faces) or a cloud (points).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "colormap.h"
#include "files.h"
#include "gaussmap/curvature.h"
#include "pictures.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Geometry;
using gaussmap::Property;

struct Options {
    std::string input;
    Outputs outputs;
    std::string as = "auto", normals = "auto", estimator = "auto", orient = "local", truth;
    int k = 20, degree = 0;
    bool color = false;
};

/// What the options come to for this input.
struct Plan {
    bool mesh = false;
    bool file_normals = false;
    std::string normals;  ///< how they come about, for the report: "file", "max", "jet 4"
    gaussmap::MeshCurvatureOptions of_mesh;
    gaussmap::CloudCurvatureOptions of_cloud;
    std::vector<std::string> notes;
};

/// What is written, and the report's part that is known after the measurement.
struct Measured {
    std::vector<double> density, kappa, face_density, normals;
    double seconds_neighbors = 0, seconds_normals = 0, seconds_curvature = 0;
    Json facts;
};

constexpr const char* about =
    "Measures the total curvature k1² + k2² of a triangle mesh or a point cloud from the variation of its "
    "normals.\n\n"
    "The density of a vertex or point (and of a face) has the unit 1/length², with the length unit of the file: "
    "it is 2/r² on a sphere of radius r. The kappa of a face is its integral over the face and has no unit. "
    "Where nothing defines it (a vertex of no face, a point with too few neighbours) the density is NaN, in "
    "files too; the report counts these.\n\n"
    "PLY files get scalar_total_curvature and quality (both the density) on the vertices, kappa and quality on "
    "the faces; everything else of the input is kept.";

constexpr const char* examples =
    "gaussmap curvature bunny.ply                       measure and report\n"
    "gaussmap curvature bunny.ply -o out.ply --color    and write it, to look at\n"
    "gaussmap curvature bunny.ply -o bunny.png          a picture of it\n"
    "gaussmap curvature scan.pcd --k 30 -o scan.ply     a cloud, 30 neighbours\n"
    "gaussmap curvature a.obj -o a.ply -o a.xyz --json  two files, a JSON report\n"
    "gaussmap curvature torus.ply --truth exact_density compare with the truth";

void declare(CommandLine& line, Options& o) {
    line.input(o.input, "IN", "A mesh or a cloud: " + gaussmap::known_extensions() + "; - is standard input");
    line.group("Method");
    line.option("--as", o.as, "KIND",
                "auto, mesh or cloud. auto: a mesh if the file has faces. cloud takes the vertices of a mesh as a "
                "cloud (default: auto)")
        ->check(one_of({"auto", "mesh", "cloud"}));
    line.option("--normals", o.normals, "N",
                "auto: those of the file if it has any, else estimate\n"
                "file: those of the file\n"
                "estimate: meshes max, clouds jet of degree 4\n"
                "max, angle, area: meshes; weights of the faces around a vertex\n"
                "pca, wpca, jet: clouds; a fitted plane, the same with near points weighing more, a fitted polynomial "
                "(default: auto)")
        ->check(one_of({"auto", "file", "estimate", "area", "angle", "max", "pca", "wpca", "jet"}));
    line.option("--estimator", o.estimator, "E",
                "dirichlet: energy of the normals (Chen 2023)\n"
                "corrected: corrected curvature measures of the vertices (Lachaud et al. 2020); meshes\n"
                "auto: dirichlet (default: auto)")
        ->check(one_of({"auto", "dirichlet", "corrected"}));
    line.group("Clouds");
    line.option("--k", o.k, "N", "Nearest neighbours a point, 3 to 1000 (default: 20)")->check(whole_number(3, 1000));
    line.option("--degree", o.degree, "N", "Degree of the jet, 1 to 4 (default: 2 for --normals jet, 4 for estimate)")
        ->check(whole_number(1, 4));
    line.option("--orient", o.orient, "O",
                "How estimated normals are made to agree. local: around each point\n"
                "mst: along a spanning tree of the whole cloud\n"
                "none: not at all (default: local)")
        ->check(one_of({"local", "mst", "none"}));
    line.group("Report");
    line.option("--truth", o.truth, "PROPERTY",
                "Compare the densities with this property of the input's vertices, and report the errors");
    o.outputs.pictures = true;
    o.outputs.declare(line, false);
    line.flag("--color", o.color,
              "Add red, green, blue: dark at density 0, bright from the 98th percentile on, grey where undefined");
}

bool fits_plane(const std::string& normals) {
    return normals == "pca" || normals == "wpca";
}

/// Options that the other kind alone understands. \throw Failure (wrong usage)
void refuse_other_kind(const Options& o, bool mesh) {
    const bool for_meshes = o.normals == "max" || o.normals == "angle" || o.normals == "area";
    const bool for_clouds = fits_plane(o.normals) || o.normals == "jet";
    if (mesh && for_clouds)
        throw Failure(Exit::wrong_usage, fmt::format("--normals {} is for clouds and {} is a mesh; use auto, file, "
                                                     "estimate, max, angle or area, or --as cloud",
                                                     o.normals, o.input));
    if (!mesh && for_meshes)
        throw Failure(Exit::wrong_usage, fmt::format("--normals {} is for meshes and {} is taken as a cloud; use auto, "
                                                     "file, estimate, pca, wpca or jet",
                                                     o.normals, o.input));
    if (!mesh && o.estimator == "corrected")
        throw Failure(Exit::wrong_usage, fmt::format("--estimator corrected is for meshes and {} is taken as a cloud; "
                                                     "use auto or dirichlet",
                                                     o.input));
}

void plan_mesh(const Options& o, Plan& plan) {
    using gaussmap::NormalWeights;
    const bool chosen = o.normals == "angle" || o.normals == "area";
    plan.normals = chosen ? o.normals : "max";
    plan.of_mesh.weights = o.normals == "angle"  ? NormalWeights::angle
                           : o.normals == "area" ? NormalWeights::area
                                                 : NormalWeights::max;
    if (o.estimator == "corrected") plan.of_mesh.estimator = gaussmap::Estimator::corrected;
}

void plan_cloud(const Options& o, Plan& plan) {
    using gaussmap::Orientation;
    plan.of_cloud.k = o.k;
    plan.of_cloud.method = o.normals == "pca"    ? gaussmap::CloudNormals::pca
                           : o.normals == "wpca" ? gaussmap::CloudNormals::weighted_pca
                                                 : gaussmap::CloudNormals::jet;
    plan.of_cloud.degree = o.degree != 0 ? o.degree : o.normals == "jet" ? 2 : 4;
    plan.of_cloud.orientation = o.orient == "mst"    ? Orientation::mst
                                : o.orient == "none" ? Orientation::none
                                                     : Orientation::local;
    plan.normals = fits_plane(o.normals) ? o.normals : fmt::format("jet {}", plan.of_cloud.degree);
}

/// \throw Failure where the options do not fit the input.
Plan make_plan(const Options& o, const CommandLine& line, const Geometry& geometry) {
    Plan plan;
    plan.mesh = taken_as_mesh(o.as, geometry, o.input);
    refuse_other_kind(o, plan.mesh);
    const bool usable = has_normals(geometry);
    if (o.normals == "file" && !usable)
        throw Failure(
            Exit::bad_input,
            fmt::format("{}: {}; use --normals estimate", o.input,
                        geometry.normals.empty() ? "has no normals" : "has normals, but all are zero or not finite"));
    plan.file_normals = usable && (o.normals == "auto" || o.normals == "file");
    if (plan.mesh)
        plan_mesh(o, plan);
    else
        plan_cloud(o, plan);
    if (plan.file_normals) plan.normals = "file";

    const bool fitted = !plan.mesh && !plan.file_normals;
    const auto unused = [&](const char* name, bool used, const char* why) {
        if (line.given(name) && !used) plan.notes.push_back(fmt::format("{} is not used: {}", name, why));
    };
    const char* why = plan.mesh ? "this is a mesh" : "the normals come from the file";
    unused("--k", !plan.mesh, why);
    unused("--orient", fitted, why);
    unused("--degree", fitted && !fits_plane(o.normals), fitted ? "a plane is fitted" : why);
    return plan;
}

Measured measure_mesh(const Geometry& geometry, const Plan& plan) {
    const std::vector<double> none;
    auto result = gaussmap::mesh_curvature(geometry.vertices, geometry.faces,
                                           plan.file_normals ? geometry.normals : none, plan.of_mesh);
    const gaussmap::DistinctPoints distinct = gaussmap::distinct_points(geometry.vertices);
    Measured out;
    out.facts = {{"kappa", {{"sum", result.kappa_sum}}},
                 {"density", statistics(result.density)},
                 {"undefined", result.undefined},
                 {"undefined_faces", result.undefined_faces},
                 {"degenerate_faces", result.degenerate_faces},
                 {"duplicates", distinct.duplicates},
                 {"non_finite", distinct.non_finite}};
    out.seconds_normals = result.seconds_normals;
    out.seconds_curvature = result.seconds_curvature;
    out.density = std::move(result.density);
    out.normals = std::move(result.normals);
    out.kappa = std::move(result.kappa);
    out.face_density = std::move(result.face_density);
    return out;
}

Measured measure_cloud(const Geometry& geometry, const Plan& plan) {
    const std::vector<double> none;
    auto result =
        gaussmap::cloud_curvature(geometry.vertices, plan.file_normals ? geometry.normals : none, plan.of_cloud);
    Measured out;
    out.facts = {{"density", statistics(result.density)}, {"undefined", result.undefined},
                 {"duplicates", result.duplicates},       {"non_finite", result.non_finite},
                 {"boundary", result.boundary},           {"lowered", result.lowered}};
    out.seconds_neighbors = result.seconds_neighbors;
    out.seconds_normals = result.seconds_normals;
    out.seconds_curvature = result.seconds_curvature;
    out.density = std::move(result.density);
    out.normals = std::move(result.normals);
    return out;
}

/// Errors of the densities where both they and the truth are defined.
Json errors(const std::vector<double>& density, const std::vector<double>& truth, const std::string& name) {
    double squares = 0, truth_squares = 0;
    std::size_t compared = 0;
    std::vector<double> relative;
    for (std::size_t i = 0; i < density.size(); ++i) {
        const double error = density[i] - truth[i];
        if (!std::isfinite(error)) continue;
        squares += error * error;
        truth_squares += truth[i] * truth[i];
        ++compared;
        if (truth[i] != 0) relative.push_back(std::abs(error / truth[i]));
    }
    // Of nothing the root mean square is 0/0 = NaN, which JSON shows as null; so is an error relative to zeros.
    const double rmse = std::sqrt(squares / static_cast<double>(compared));
    const double scale = std::sqrt(truth_squares / static_cast<double>(compared));
    return {{"property", name},
            {"rmse", rmse},
            {"relative_rmse", scale > 0 ? Json(rmse / scale) : Json()},
            {"median_relative_error", statistics(relative)["p50"]},
            {"compared", compared}};
}

/// Put the results on the geometry.
void attach(Geometry& geometry, const Measured& measured, const Options& o, std::vector<std::string>& notes) {
    using gaussmap::make_property;
    for (const char* name : {"scalar_total_curvature", "quality"}) {
        if (geometry.vertex_property(name))
            notes.push_back(fmt::format("the vertex property '{}' of the input is replaced", name));
        set_property(geometry.vertex_properties, make_property(name, measured.density));
    }
    if (!measured.kappa.empty()) {
        if (!geometry.polygons.empty()) {
            notes.push_back("polygons are written as triangles, each with its own kappa");
            geometry = gaussmap::triangulate(geometry);
        }
        set_property(geometry.face_properties, make_property("kappa", measured.kappa));
        set_property(geometry.face_properties, make_property("quality", measured.face_density));
    }
    if (!o.color) return;
    const Json& top = measured.facts["density"]["p98"];
    for (Property& property : color_properties(measured.density, top.is_null() ? 0 : top.get<double>()))
        set_property(geometry.vertex_properties, std::move(property));
}

Json report_on(const Options& o, const Plan& plan, const Geometry& geometry, const Measured& measured,
               const Common& common) {
    Json report = {{"kind", plan.mesh ? "mesh" : "cloud"}, {"file", o.input}};
    report["vertices"] = geometry.vertex_count();
    report["faces"] = geometry.face_count();
    report["normals"] = plan.normals;
    report["estimator"] = o.estimator == "auto" ? "dirichlet" : o.estimator;
    report["k"] = plan.mesh ? Json() : Json(o.k);
    report["orient"] = plan.mesh || plan.file_normals ? Json() : Json(o.orient);
    report["threads"] = common.threads;
    report.update(measured.facts);
    return report;
}

std::string hint_of_cuts(const Json& report) {
    return fmt::format("{} the position of another: the surface is cut there; gaussmap convert --weld joins it",
                       count(report["duplicates"].get<std::size_t>(), "vertex repeats", "vertices repeat"));
}

Table table_of(const Json& report) {
    const bool mesh = report["kind"] == "mesh";
    const auto n = [&](const char* key) { return report[key].get<std::size_t>(); };
    const char *const one = mesh ? "vertex" : "point", *const many = mesh ? "vertices" : "points";
    Table table;
    table.add("normals", report["normals"].get<std::string>());
    table.add("estimator", report["estimator"].get<std::string>());
    if (!mesh) table.add("neighbours", number(report["k"]));
    const Json& d = report["density"];
    table.add("density", fmt::format("mean {}, rms {}, from {} to {} (1/unit²)", number(d["mean"]), number(d["rms"]),
                                     number(d["min"]), number(d["max"])));
    table.add("percentiles",
              fmt::format("2 %: {}, 50 %: {}, 98 %: {}", number(d["p02"]), number(d["p50"]), number(d["p98"])));
    if (mesh) table.add("kappa", "sum " + number(report["kappa"]["sum"]) + " (no unit)");
    table.add("undefined", count(n("undefined"), one, many) +
                               (mesh ? ", " + count(n("undefined_faces"), "face", "faces") : std::string()));
    if (mesh) table.add("degenerate", count(n("degenerate_faces"), "face", "faces") + " of no area");
    table.add("duplicate", count(n("duplicates"), one, many) + " at the position of an earlier one");
    table.add("non-finite", count(n("non_finite"), one, many));
    if (!mesh) table.add("boundary", count(n("boundary"), one, many));
    if (!mesh && n("lowered") > 0) table.add("lower degree", count(n("lowered"), one, many));
    if (const auto truth = report.find("truth"); truth != report.end())
        table.add("truth", fmt::format("{}: RMSE {}, relative {}, median relative error {}, {} compared",
                                       (*truth)["property"].get<std::string>(), number((*truth)["rmse"]),
                                       number((*truth)["relative_rmse"]), number((*truth)["median_relative_error"]),
                                       count((*truth)["compared"].get<std::size_t>(), one, many)));
    add_ending(table, report);
    return table;
}

std::string title_of(const Json& report) {
    const std::string vertices = count(report["vertices"].get<std::size_t>(), "vertex", "vertices");
    if (report["kind"] == "cloud")
        return fmt::format("{}: a cloud of {}", report["file"].get<std::string>(),
                           count(report["vertices"].get<std::size_t>(), "point", "points"));
    return fmt::format("{}: a mesh of {} and {}", report["file"].get<std::string>(), vertices,
                       count(report["faces"].get<std::size_t>(), "face", "faces"));
}

}  // namespace

void curvature(int argc, char** argv) {
    Options o;
    CommandLine line("curvature IN [-o OUT]… [options]", about, examples);
    declare(line, o);
    if (!line.parse(argc, argv)) return;
    o.outputs.check(line);

    Stopwatch watch;
    Geometry geometry = read_input(o.input, line.common);
    const double seconds_read = watch.lap();
    Plan plan = make_plan(o, line, geometry);
    o.outputs.check_fit(geometry);
    const std::vector<double> truth = o.truth.empty()
                                          ? std::vector<double>()
                                          : vertex_property(geometry, o.truth, o.input, "to compare with").as_double();

    const Measured measured = concerning(o.input, [&] {
        Progress progress("measuring curvature", line.common.quiet);
        plan.of_mesh.run = plan.of_cloud.run = progress.run(line.common.threads);
        return plan.mesh ? measure_mesh(geometry, plan) : measure_cloud(geometry, plan);
    });
    Json report = report_on(o, plan, geometry, measured, line.common);
    if (!o.truth.empty()) report["truth"] = errors(measured.density, truth, o.truth);

    std::vector<std::string> notes = geometry.notes;
    notes.insert(notes.end(), plan.notes.begin(), plan.notes.end());
    if (plan.mesh && report["duplicates"] > 0) notes.push_back(hint_of_cuts(report));
    watch.lap();
    if (o.outputs.any_picture())
        concerning(o.input, [&] {
            draw_pictures(o.outputs, geometry, plan.mesh, measured.density, measured.normals, {}, line.common);
        });
    if (o.outputs.any_geometry()) {
        attach(geometry, measured, o, notes);
        o.outputs.write(geometry);
        for (const std::string& loss : o.outputs.losses(geometry)) notes.push_back(loss);
    }
    report["seconds"] = {{"read", seconds_read},
                         {"normals", measured.seconds_normals},
                         {"neighbors", measured.seconds_neighbors},
                         {"curvature", measured.seconds_curvature},
                         {"write", watch.lap()},
                         {"total", watch.total()}};
    report["peak_bytes"] = peak_bytes();
    report["outputs"] = o.outputs.paths;
    report["notes"] = notes;
    present(report, title_of(report), table_of(report), line.common);
}

}  // namespace cli
