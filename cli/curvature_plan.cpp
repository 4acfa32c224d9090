#include "curvature_plan.h"

#include <fmt/format.h>

namespace cli {
namespace {

using gaussmap::Estimator;

constexpr Estimator estimators[] = {Estimator::automatic, Estimator::dirichlet, Estimator::corrected,
                                    Estimator::regression, Estimator::jet};

bool weighs_faces(const std::string& normals) {
    return normals == "max" || normals == "angle" || normals == "area";
}

bool fits_plane(const std::string& normals) {
    return normals == "pca" || normals == "wpca";
}

/// Options that the other kind alone understands. \throw Failure (wrong usage)
void refuse_other_kind(const CurvatureOptions& o, bool mesh) {
    const bool for_meshes = weighs_faces(o.normals);
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
                                                     "use auto, dirichlet, regression or jet",
                                                     o.input));
}

/// What only some estimators have or understand. \throw Failure (wrong usage)
void refuse_what_estimator_lacks(const CurvatureOptions& o, Estimator estimator) {
    const char* name = gaussmap::estimator_name(estimator);
    if (o.confidence && (estimator == Estimator::dirichlet || estimator == Estimator::corrected))
        throw Failure(Exit::wrong_usage,
                      fmt::format("--confidence comes from the residuals of a fit, and --estimator {} "
                                  "fits nothing; use --estimator auto, regression or jet",
                                  name));
    if (estimator == Estimator::jet && o.degree == 1)
        throw Failure(Exit::wrong_usage, "--degree 1 has no curvature; --estimator jet takes 2 to 4");
    if (estimator == Estimator::jet && o.k < 5)
        throw Failure(Exit::wrong_usage, fmt::format("--k {} is too small; --estimator jet takes at least 5", o.k));
    if (o.choice && estimator != Estimator::automatic)
        throw Failure(
            Exit::wrong_usage,
            fmt::format("--choice is what --estimator auto took, and the estimator is {}; use --estimator auto", name));
}

/// Clouds are measured with `auto`, unless options ask for normals or fans of some kind.
Estimator estimator_for(const CurvatureOptions& o, const CommandLine& line, bool mesh) {
    for (const Estimator estimator : estimators)
        if (o.estimator == gaussmap::estimator_name(estimator)) return estimator;
    const bool plain = o.normals == "auto" || o.normals == "estimate";
    const bool asked = line.given("--k") || line.given("--degree") || line.given("--orient") || !plain;
    return mesh || asked ? Estimator::dirichlet : Estimator::automatic;
}

void plan_mesh(const CurvatureOptions& o, CurvaturePlan& plan) {
    using gaussmap::NormalWeights;
    const bool chosen = weighs_faces(o.normals);
    plan.of_mesh.k = o.k;
    plan.of_mesh.degree = o.degree != 0 ? o.degree : 4;
    plan.mesh_normals = chosen && plan.estimator() == Estimator::regression;
    const bool fitted = plan.estimator() == Estimator::regression && !chosen;
    plan.normals = fitted ? fmt::format("jet {}", plan.of_mesh.degree) : chosen ? o.normals : "max";
    plan.of_mesh.weights = o.normals == "angle"  ? NormalWeights::angle
                           : o.normals == "area" ? NormalWeights::area
                                                 : NormalWeights::max;
}

void plan_cloud(const CurvatureOptions& o, CurvaturePlan& plan) {
    using gaussmap::Orientation;
    plan.of_cloud.k = o.k;
    plan.of_cloud.method = o.normals == "pca"    ? gaussmap::CloudNormals::pca
                           : o.normals == "wpca" ? gaussmap::CloudNormals::weighted_pca
                                                 : gaussmap::CloudNormals::jet;
    const bool quadric = o.normals == "jet" && o.estimator != "jet";
    plan.of_cloud.degree = o.degree != 0 ? o.degree : quadric ? 2 : 4;
    plan.of_cloud.orientation = o.orient == "mst"    ? Orientation::mst
                                : o.orient == "none" ? Orientation::none
                                                     : Orientation::local;
    plan.normals = fits_plane(o.normals) ? o.normals : fmt::format("jet {}", plan.of_cloud.degree);
}

void note_unused(const CommandLine& line, CurvaturePlan& plan, const char* name, bool used, const char* why) {
    if (line.given(name) && !used) plan.notes.push_back(fmt::format("{} is not used: {}", name, why));
}

/// Notes of options that were given for a mesh and are not used.
void note_lost_on_mesh(const CommandLine& line, CurvaturePlan& plan) {
    const Estimator estimator = plan.estimator();
    const bool jet = estimator == Estimator::jet, regression = estimator == Estimator::regression;
    const bool automatic = estimator == Estimator::automatic, given = plan.file_normals || plan.mesh_normals;
    const char* why = automatic ? "--estimator auto chooses for itself" : "it is for --estimator jet and regression";
    note_unused(line, plan, "--k", jet || regression, why);
    note_unused(line, plan, "--orient", false, "this is a mesh");
    note_unused(line, plan, "--degree", jet || (regression && !given), regression ? "the normals are not fitted" : why);
}

/// Notes of options that were given for a cloud and are not used, and of signs.
void note_lost_on_cloud(const CurvatureOptions& o, const CommandLine& line, CurvaturePlan& plan) {
    const Estimator estimator = plan.estimator();
    const bool fitted = !plan.file_normals, automatic = estimator == Estimator::automatic;
    const bool jet = estimator == Estimator::jet;
    const bool turned = fitted && estimator == Estimator::dirichlet;
    const char* why = automatic ? "--estimator auto chooses for itself" : "the normals come from the file";
    note_unused(line, plan, "--k", !automatic, why);
    note_unused(line, plan, "--orient", turned, fitted && !automatic ? "it is for --estimator dirichlet" : why);
    note_unused(line, plan, "--degree", jet || (fitted && !automatic && !fits_plane(o.normals)),
                fitted && !automatic ? "a plane is fitted" : why);
    if (automatic && o.normals == "file")
        plan.notes.push_back("--normals file tells the signs alone: --estimator auto fits its own");
    else if (automatic)
        note_unused(line, plan, "--normals", o.normals == "auto" || o.normals == "estimate", why);
    else
        note_unused(line, plan, "--normals", !jet || (!fits_plane(o.normals) && o.normals != "jet"),
                    "the jet has a normal of its own");
    if (o.tensor && fitted && !(turned && o.orient == "mst"))
        plan.notes.push_back(
            fmt::format("each point has its own normal's side, so the signs of k1, k2, mean and shape_index "
                        "need not agree from point to point; {}",
                        turned      ? "--orient mst makes them"
                        : automatic ? "normals in the file make them, and gaussmap normals writes such"
                                    : "normals in the file make them"));
}

}  // namespace

void CurvatureOptions::declare(CommandLine& line) {
    line.input(input, "IN", "A mesh or a cloud: " + gaussmap::known_extensions() + "; - is standard input");
    line.group("Method");
    line.option("--as", as, "KIND",
                "auto, mesh or cloud. auto: a mesh if the file has faces. cloud takes the vertices of a mesh as a "
                "cloud (default: auto)",
                one_of({"auto", "mesh", "cloud"}));
    line.option("--normals", normals, "N",
                "auto: those of the file if it has any, else estimate\n"
                "file: those of the file\n"
                "estimate: clouds and --estimator regression jet of degree 4, else max\n"
                "max, angle, area: meshes; weights of the faces around a vertex\n"
                "pca, wpca, jet: clouds; a fitted plane, the same with near points weighing more, a fitted polynomial "
                "(default: auto)",
                one_of({"auto", "file", "estimate", "area", "angle", "max", "pca", "wpca", "jet"}));
    line.option(
        "--estimator", estimator, "E",
        "dirichlet: energy of the normals (Chen 2023)\n"
        "corrected: corrected curvature measures of the vertices (Lachaud et al. 2020); meshes\n"
        "regression: least squares of the differences of neighbours' normals\n"
        "jet: curvature of a fitted polynomial, which needs no normals\n"
        "auto: what suits each vertex or point best; on clouds surfaces fitted to the points, where normals tell "
        "signs alone (default: clouds auto, unless --k, --degree, --orient or --normals ask for normals of some "
        "kind; else dirichlet)",
        one_of({"auto", "dirichlet", "corrected", "regression", "jet"}));
    line.group("Fits and clouds");
    line.option(
        "--k", k, "N",
        "Nearest neighbours of a point, 3 to 1000; of a vertex, along edges, for --estimator jet and regression "
        "(default: 20; auto chooses)",
        whole_number(3, 1000));
    line.option("--degree", degree, "N",
                "Degree of the jet, 1 to 4, from 2 for --estimator jet (default: 2 for --normals jet, else 4)",
                whole_number(1, 4));
    line.option("--orient", orient, "O",
                "Clouds: how estimated normals are made to agree. local: around each point\n"
                "mst: along a spanning tree of the whole cloud\n"
                "none: not at all (default: local)",
                one_of({"local", "mst", "none"}));
    line.group("Also");
    line.flag("--tensor", tensor,
              "Principal curvatures and directions: k1 ≥ k2 (1/length), positive where the surface bends away from its "
              "normal, d1x d1y d1z (direction of k1), mean, gaussian, shape_index and curvedness");
    line.flag("--confidence", confidence,
              "density_error: the standard error of each density (estimators auto, regression and jet)");
    line.flag("--choice", choice, "choice: what --estimator auto took for each vertex or point");
    line.group("Report");
    line.option("--truth", truth, "PROPERTY",
                "Compare the densities with this property of the input's vertices, and report the errors");
    outputs.pictures = outputs.pages = true;
    outputs.declare(line, false);
    line.flag("--color", color,
              "Add red, green, blue: dark at density 0, bright from the 98th percentile on, grey where undefined");
}

CurvaturePlan plan_curvature(const CurvatureOptions& o, const CommandLine& line, const gaussmap::Geometry& geometry) {
    CurvaturePlan plan;
    plan.mesh = taken_as_mesh(o.as, geometry, o.input);
    refuse_other_kind(o, plan.mesh);
    plan.of_mesh.estimator = plan.of_cloud.estimator = estimator_for(o, line, plan.mesh);
    refuse_what_estimator_lacks(o, plan.estimator());
    plan.of_mesh.tensor = plan.of_cloud.tensor = o.tensor;
    plan.of_mesh.confidence = plan.of_cloud.confidence = o.confidence;
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
    if (plan.estimator() == Estimator::automatic)
        plan.normals = "fitted";
    else if (plan.estimator() == Estimator::jet)
        plan.normals = fmt::format("jet {}", plan.mesh ? plan.of_mesh.degree : plan.of_cloud.degree);
    else if (plan.file_normals)
        plan.normals = "file";
    if (plan.mesh)
        note_lost_on_mesh(line, plan);
    else
        note_lost_on_cloud(o, line, plan);
    return plan;
}

}  // namespace cli
