// gaussmap compare: how far two surfaces or clouds are from each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files.h"
#include "gaussmap/distance.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Geometry;

struct Options {
    std::string a, b;
    std::size_t samples = gaussmap::DistanceOptions().samples;
    bool bound = false;
    double tolerance = 1e-4;
};

constexpr const char* about =
    "Measures the distances from A to B and back: from points all over the one to the closest point of the other, "
    "which "
    "is exact. Meshes are sampled on their vertices, edges and faces; of a file without faces its points are taken. "
    "The maximum is over all samples, a lower bound of the Hausdorff distance; mean and RMS are over the area (a "
    "cloud's points). All are divided by the diagonal of A's bounding box, as in MeshLab.\n\n"
    "--bound adds an interval that the Hausdorff distance is certain to lie in, each way.";

constexpr const char* examples =
    "gaussmap compare before.ply after.ply           distances both ways\n"
    "gaussmap compare before.ply after.ply --bound   and the Hausdorff distance\n"
    "gaussmap compare mesh.obj scan.pcd              a mesh and a cloud\n"
    "gaussmap compare a.ply b.ply --samples 5000000 --json   for a script";

void declare(CommandLine& line, Options& o) {
    line.input(o.a, "A", "A mesh or a cloud: " + gaussmap::known_extensions() + "; - is standard input");
    line.input(o.b, "B", "Another");
    line.group("Samples");
    line.option("--samples", o.samples, "N",
                "Points on the faces of each mesh, and a quarter as many on its edges; all vertices besides (default: "
                "500000)",
                whole_number(1, 100000000));
    line.option("--seed", line.common.seed, "N", "Of where they are (default: 0)", whole_number(0, INT64_MAX));
    line.group("Bounds");
    line.flag("--bound", o.bound, "Bound the Hausdorff distances with certainty");
    line.option("--tolerance", o.tolerance, "T",
                "How far apart the bounds may be, divided by the diagonal of A (default: 0.0001)", positive_number());
}

/// Points without a place are left out of a cloud, and counted.
std::size_t drop_non_finite(Geometry& geometry) {
    if (!geometry.faces.empty()) return 0;
    std::vector<double> kept;
    for (std::size_t i = 0; i < geometry.vertices.size(); i += 3) {
        const double* p = &geometry.vertices[i];
        if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) kept.insert(kept.end(), p, p + 3);
    }
    const std::size_t dropped = (geometry.vertices.size() - kept.size()) / 3;
    if (dropped > 0) geometry.vertices = std::move(kept);
    return dropped;
}

struct Side {
    std::string path;
    Geometry geometry;
    std::size_t non_finite = 0;
};

Side read_side(const std::string& path, const Common& common) {
    Side side{path, read_input(path, common), 0};
    taken_as_mesh("auto", side.geometry, path);  // refuses what has no points
    side.non_finite = drop_non_finite(side.geometry);
    if (side.geometry.vertices.empty())
        throw Failure(Exit::bad_input, path + ": no point is finite; there is nothing to compare");
    return side;
}

/// Run the work; what it finds wrong with "a: …" or "b: …" is told of the file.
template <class Work>
auto concerning_both(const Options& o, Work&& work) {
    try {
        return work();
    } catch (const std::invalid_argument& error) {
        const std::string text = error.what();
        throw Failure(Exit::bad_input, (text.starts_with("a: ") ? o.a : o.b) + text.substr(1));
    }
}

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json divided(const gaussmap::Deviation& way, double diagonal) {
    return {{"max", finite_or_null(way.max / diagonal)},
            {"rms", finite_or_null(way.rms / diagonal)},
            {"mean", finite_or_null(way.mean / diagonal)}};
}

Json counts(const gaussmap::SampleCounts& samples) {
    return {{"vertices", samples.vertices}, {"edges", samples.edges}, {"faces", samples.faces}};
}

std::size_t total(const gaussmap::SampleCounts& samples) {
    return samples.vertices + samples.edges + samples.faces;
}

Json side_report(const Side& side) {
    return {{"file", side.path},
            {"kind", side.geometry.faces.empty() ? "cloud" : "mesh"},
            {"vertices", side.geometry.vertex_count()},
            {"faces", side.geometry.face_count()},
            {"non_finite", side.non_finite}};
}

gaussmap::HausdorffInterval bound(const Side& from, const Side& to, double tolerance, const Common& common,
                                  const std::string& what) {
    Progress progress(what, common.quiet);
    gaussmap::HausdorffOptions options;
    options.tolerance = tolerance;
    options.run = progress.run(common.threads);
    const gaussmap::ClosestIndex index(to.geometry.vertices, to.geometry.faces, {common.threads, {}});
    return gaussmap::hausdorff_bound(from.geometry.vertices, from.geometry.faces, index, options);
}

/// Both ways, divided by the diagonal.
Json bounds(const Side& a, const Side& b, double diagonal, const Options& o, const Common& common) {
    const double tolerance = o.tolerance * diagonal;
    const gaussmap::HausdorffInterval forward = bound(a, b, tolerance, common, "bounding A to B"),
                                      backward = bound(b, a, tolerance, common, "bounding B to A");
    const auto way = [&](const gaussmap::HausdorffInterval& found) -> Json {
        return {{"lower", finite_or_null(found.lower / diagonal)},
                {"upper", finite_or_null(found.upper / diagonal)},
                {"at", found.at},
                {"within_tolerance", found.within_tolerance}};
    };
    return {{"tolerance", o.tolerance},
            {"forward", way(forward)},
            {"backward", way(backward)},
            {"symmetric",
             {{"lower", finite_or_null(std::max(forward.lower, backward.lower) / diagonal)},
              {"upper", finite_or_null(std::max(forward.upper, backward.upper) / diagonal)}}}};
}

Table table_of(const Json& report) {
    Table table;
    for (const char* side : {"a", "b"}) {
        const Json& of = report[side];
        table.add(side == std::string("a") ? "A" : "B",
                  fmt::format("{}: {}, {}", of["file"].get<std::string>(),
                              count(of["vertices"].get<std::size_t>(), "vertex", "vertices"),
                              count(of["faces"].get<std::size_t>(), "face", "faces")));
    }
    const std::pair<const char*, const char*> ways[] = {
        {"forward", "A to B"}, {"backward", "B to A"}, {"symmetric", "both"}};
    for (const auto& [key, label] : ways) {
        const Json& way = report[key];
        table.add(label,
                  fmt::format("max {}, RMS {}, mean {}", number(way["max"]), number(way["rms"]), number(way["mean"])));
    }
    if (report.contains("bound"))
        for (const auto& [key, label] : ways) {
            const Json& way = report["bound"][key];
            table.add(fmt::format("Hausdorff, {}", label),
                      fmt::format("from {} to {}, for certain", number(way["lower"]), number(way["upper"])));
        }
    table.add("divided by", number(report["diagonal"]) + ", the diagonal of A");
    table.add("samples", count(report["samples"].get<std::size_t>()));
    add_ending(table, report);
    return table;
}

}  // namespace

void compare(int argc, char** argv) {
    Options o;
    CommandLine line("compare A B [options]", about, examples);
    declare(line, o);
    if (!line.parse(argc, argv)) return;
    if (o.a == "-" && o.b == "-")
        throw Failure(Exit::wrong_usage, "compare: A and B cannot both be standard input; name a file for one");

    Stopwatch watch;
    const Side a = read_side(o.a, line.common), b = read_side(o.b, line.common);
    const double reading = watch.lap();
    const gaussmap::SurfaceDistance found = concerning_both(o, [&] {
        Progress progress("comparing", line.common.quiet);
        return gaussmap::surface_distance(a.geometry.vertices, a.geometry.faces, b.geometry.vertices, b.geometry.faces,
                                          {o.samples, line.common.seed, progress.run(line.common.threads)});
    });
    const double comparing = watch.lap();

    Json report = {{"a", side_report(a)}, {"b", side_report(b)}};
    report["forward"] = divided(found.forward, found.diagonal);
    report["backward"] = divided(found.backward, found.diagonal);
    report["symmetric"] = divided(found.symmetric, found.diagonal);
    report["diagonal"] = found.diagonal;
    report["samples"] = total(found.forward_samples) + total(found.backward_samples);
    report["samples_by_kind"] = {{"forward", counts(found.forward_samples)},
                                 {"backward", counts(found.backward_samples)}};
    if (o.bound) report["bound"] = bounds(a, b, found.diagonal, o, line.common);
    report["seed"] = line.common.seed;
    report["threads"] = line.common.threads;
    report["seconds"] = {
        {"read", reading}, {"compare", comparing}, {"bound", o.bound ? watch.lap() : 0.0}, {"total", watch.total()}};
    report["peak_bytes"] = peak_bytes();
    report["outputs"] = Json::array();
    report["notes"] = Json::array();
    for (const Side* side : {&a, &b}) {
        for (const std::string& note : side->geometry.notes) report["notes"].push_back(side->path + ": " + note);
        if (side->non_finite > 0)
            report["notes"].push_back(fmt::format("{}: {} left out, being not finite", side->path,
                                                  count(side->non_finite, "point", "points")));
    }
    if (o.bound && !(report["bound"]["forward"]["within_tolerance"] && report["bound"]["backward"]["within_tolerance"]))
        report["notes"].push_back("the bounds are farther apart than --tolerance: it would have taken too long");
    present(report, fmt::format("{} and {}", o.a, o.b), table_of(report), line.common);
}

}  // namespace cli
