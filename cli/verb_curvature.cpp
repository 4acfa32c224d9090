// gaussmap curvature: total curvature of a mesh (vertices and faces) or a cloud (points).
#include <fmt/format.h>

#include <algorithm>

#include "colormap.h"
#include "curvature_plan.h"
#include "curvature_report.h"
#include "pages.h"
#include "pictures.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Geometry;
using gaussmap::make_property;
using gaussmap::Property;

constexpr const char* about =
    "Measures the total curvature k1² + k2² of a triangle mesh from the variation of its normals, or of a point "
    "cloud from surfaces fitted to it, or from its normals.\n\n"
    "The density of a vertex or point (and of a face) has the unit 1/length², with the length unit of the file: "
    "it is 2/r² on a sphere of radius r. The kappa of a face is its integral over the face and has no unit. "
    "Where nothing defines it (a vertex of no face, a point with too few neighbours) the density is NaN, in "
    "files too; the report counts these.\n\n"
    "PLY files get scalar_total_curvature and quality (both the density) on the vertices, kappa and quality on "
    "the faces, and keep everything that the input had. --tensor adds the principal curvatures to both; XYZ and PCD "
    "hold those of the vertices.";

constexpr const char* examples =
    "gaussmap curvature bunny.ply                       measure and report\n"
    "gaussmap curvature bunny.ply -o out.ply --color    and write it, to look at\n"
    "gaussmap curvature bunny.ply -o bunny.png          a picture of it\n"
    "gaussmap curvature a.ply --tensor -o a.html        a page, k1 and k2 too\n"
    "gaussmap curvature scan.pcd --k 30 -o scan.ply     a cloud, fans of 30\n"
    "gaussmap curvature a.obj -o a.ply -o a.xyz --json  two files, a JSON report\n"
    "gaussmap curvature a.ply --tensor -o b.ply         k1, k2, directions\n"
    "gaussmap curvature torus.ply --truth exact_density compare with the truth";

Measured measure_mesh(const Geometry& geometry, const CurvaturePlan& plan) {
    const std::vector<double> own = plan.mesh_normals ? gaussmap::mesh_normals(geometry.vertices, geometry.faces,
                                                                               plan.of_mesh.weights, plan.of_mesh.run)
                                                      : std::vector<double>();
    auto result = gaussmap::mesh_curvature(geometry.vertices, geometry.faces,
                                           plan.file_normals ? geometry.normals : own, plan.of_mesh);
    const gaussmap::DistinctPoints distinct = gaussmap::distinct_points(geometry.vertices);
    Measured out;
    out.counts = {{"undefined", result.undefined},
                  {"undefined_faces", result.undefined_faces},
                  {"degenerate_faces", result.degenerate_faces},
                  {"duplicates", distinct.duplicates},
                  {"non_finite", distinct.non_finite},
                  {"lowered", result.lowered}};
    out.kappa_sum = result.kappa_sum;
    out.seconds_normals = result.seconds_normals;
    out.seconds_curvature = result.seconds_curvature;
    out.density = std::move(result.density);
    out.normals = std::move(result.normals);
    out.kappa = std::move(result.kappa);
    out.face_density = std::move(result.face_density);
    out.error = std::move(result.error);
    out.tensor = std::move(result.vertex_tensor);
    out.face_tensor = std::move(result.face_tensor);
    out.choice = std::move(result.choice);
    return out;
}

Measured measure_cloud(const Geometry& geometry, const CurvaturePlan& plan) {
    const std::vector<double> none;
    auto result =
        gaussmap::cloud_curvature(geometry.vertices, plan.file_normals ? geometry.normals : none, plan.of_cloud);
    Measured out;
    out.counts = {{"undefined", result.undefined},
                  {"duplicates", result.duplicates},
                  {"non_finite", result.non_finite},
                  {"boundary", plan.automatic_cloud() ? Json() : Json(result.boundary)},
                  {"lowered", result.lowered}};
    out.seconds_neighbors = result.seconds_neighbors;
    out.seconds_normals = result.seconds_normals;
    out.seconds_curvature = result.seconds_curvature;
    out.density = std::move(result.density);
    out.normals = std::move(result.normals);
    out.error = std::move(result.error);
    out.tensor = std::move(result.tensor);
    out.choice = std::move(result.choice);
    return out;
}

/// One value an element made of its k1 and k2.
std::vector<double> of_both(const gaussmap::PrincipalCurvatures& tensor, double (*function)(double, double)) {
    std::vector<double> out(tensor.k1.size());
    std::transform(tensor.k1.begin(), tensor.k1.end(), tensor.k2.begin(), out.begin(), function);
    return out;
}

void add_directions(std::vector<Property>& properties, const std::vector<double>& direction) {
    const char* const names[] = {"d1x", "d1y", "d1z"};
    std::vector<double> values(direction.size() / 3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = direction[3 * i + axis];
        properties.push_back(make_property(names[axis], values));
    }
}

std::vector<Property> vertex_results(const Measured& measured, const CurvatureOptions& o) {
    const gaussmap::PrincipalCurvatures& tensor = measured.tensor;
    std::vector<Property> out = {make_property("scalar_total_curvature", measured.density),
                                 make_property("quality", measured.density)};
    if (o.confidence) out.push_back(make_property("density_error", measured.error));
    if (o.choice)
        out.push_back(make_property("choice", {measured.choice.begin(), measured.choice.end()}, gaussmap::Type::uint8));
    if (!o.tensor) return out;
    out.push_back(make_property("k1", tensor.k1));
    out.push_back(make_property("k2", tensor.k2));
    out.push_back(make_property("mean", of_both(tensor, gaussmap::mean_curvature)));
    out.push_back(make_property("gaussian", of_both(tensor, gaussmap::gaussian_curvature)));
    out.push_back(make_property("shape_index", of_both(tensor, gaussmap::shape_index)));
    out.push_back(make_property("curvedness", of_both(tensor, gaussmap::curvedness)));
    add_directions(out, tensor.direction);
    return out;
}

std::vector<Property> face_results(const Measured& measured, const CurvatureOptions& o) {
    std::vector<Property> out = {make_property("kappa", measured.kappa),
                                 make_property("quality", measured.face_density)};
    if (!o.tensor) return out;
    out.push_back(make_property("k1", measured.face_tensor.k1));
    out.push_back(make_property("k2", measured.face_tensor.k2));
    add_directions(out, measured.face_tensor.direction);
    return out;
}

/// Put the results on the geometry.
void attach(Geometry& geometry, const Measured& measured, const CurvatureOptions& o, const CurvaturePlan& plan,
            std::vector<std::string>& notes) {
    std::vector<std::string> replaced;
    for (Property& property : vertex_results(measured, o)) {
        if (geometry.vertex_property(property.name)) replaced.push_back(property.name);
        set_property(geometry.vertex_properties, std::move(property));
    }
    if (!replaced.empty())
        notes.push_back(fmt::format("the vertex {} {} of the input {} replaced",
                                    replaced.size() == 1 ? "property" : "properties", listed(replaced),
                                    replaced.size() == 1 ? "is" : "are"));
    if (plan.mesh) {
        if (!geometry.polygons.empty()) {
            notes.push_back("polygons are written as triangles, each with its own kappa");
            geometry = gaussmap::triangulate(geometry);
        }
        for (Property& property : face_results(measured, o))
            set_property(geometry.face_properties, std::move(property));
    }
    if (!o.color) return;
    const Json top = statistics(measured.density)["p98"];
    for (Property& property : color_properties(measured.density, top.is_null() ? 0 : top.get<double>()))
        set_property(geometry.vertex_properties, std::move(property));
}

/// What was measured as PLY files hold it, and the truth beside it.
void write_pages(const Geometry& geometry, const Measured& measured, const CurvatureOptions& o,
                 const CurvaturePlan& plan, const Common& common) {
    gaussmap::PageScene scene = page_scene(o.input, geometry, plan.mesh, measured.normals);
    add_measured(scene, "density", measured.density);
    add_properties(scene, vertex_results(measured, o), false);
    if (plan.mesh) add_measured(scene, "kappa", measured.kappa, true);
    if (!o.truth.empty()) add_properties(scene, {*geometry.vertex_property(o.truth)}, false);
    write_pages(o.outputs, {scene}, {}, common);
}

std::string hint_of_cuts(const Json& report) {
    return fmt::format("{} the position of another: the surface is cut there; gaussmap convert --weld joins it",
                       count(report["duplicates"].get<std::size_t>(), "vertex repeats", "vertices repeat"));
}

}  // namespace

void curvature(int argc, char** argv) {
    CurvatureOptions o;
    CommandLine line("curvature IN [-o OUT]… [options]", about, examples);
    o.declare(line);
    if (!line.parse(argc, argv)) return;
    o.outputs.check(line);

    Stopwatch watch;
    Geometry geometry = read_input(o.input, line.common);
    const double seconds_read = watch.lap();
    CurvaturePlan plan = plan_curvature(o, line, geometry);
    o.outputs.check_fit(geometry);
    const std::vector<double> truth = o.truth.empty()
                                          ? std::vector<double>()
                                          : vertex_property(geometry, o.truth, o.input, "to compare with").as_double();

    const Measured measured = concerning(o.input, [&] {
        Progress progress("measuring curvature", line.common.quiet);
        plan.of_mesh.run = plan.of_cloud.run = progress.run(line.common.threads);
        return plan.mesh ? measure_mesh(geometry, plan) : measure_cloud(geometry, plan);
    });
    Json report = curvature_report(o, plan, geometry, measured, truth, line.common.threads);

    std::vector<std::string> notes = geometry.notes;
    notes.insert(notes.end(), plan.notes.begin(), plan.notes.end());
    if (plan.mesh && report["duplicates"].get<std::size_t>() > 0) notes.push_back(hint_of_cuts(report));
    watch.lap();
    if (o.outputs.any_picture())
        concerning(o.input, [&] {
            draw_pictures(o.outputs, geometry, plan.mesh, measured.density, measured.normals, {}, line.common);
        });
    if (o.outputs.any_page()) concerning(o.input, [&] { write_pages(geometry, measured, o, plan, line.common); });
    if (o.outputs.any_geometry()) {
        attach(geometry, measured, o, plan, notes);
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
    present(report, curvature_title(report), curvature_table(report), line.common);
}

}  // namespace cli
