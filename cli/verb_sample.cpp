// gaussmap sample: points on a mesh, with what its vertices carry.
#include <fmt/format.h>

#include <algorithm>

#include "files.h"
#include "gaussmap/sampling.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

using gaussmap::Geometry;
using gaussmap::Property;
using gaussmap::SurfacePoints;

struct Options {
    std::string input, method = "poisson";
    std::size_t count = 10000;
    Outputs outputs;
};

constexpr const char* about =
    "Spreads points over the faces of a mesh and writes them as a cloud. Normals, colours and other values of the "
    "vertices are interpolated; whole numbers such as labels are those of the nearest corner. A mesh without normals "
    "gives points without: gaussmap normals makes some.";

constexpr const char* examples =
    "gaussmap sample bunny.ply -o points.ply                   10000, evenly\n"
    "gaussmap sample bunny.ply -o p.xyz --count 2000 --seed 7  fewer, and others\n"
    "gaussmap sample bunny.ply -o p.ply --method random        by area alone\n"
    "gaussmap normals cow.obj -o n.ply                         first, for points\n"
    "gaussmap sample n.ply -o p.ply                            that have normals";

void declare(CommandLine& line, Options& o) {
    line.input(o.input, "MESH", "A mesh: " + gaussmap::known_extensions() + "; - is standard input");
    line.group("Points");
    line.option("--count", o.count, "N", "How many, exactly (default: 10000)", whole_number(1, 100000000));
    line.option("--method", o.method, "M",
                "poisson: Poisson-disk, no two near each other\n"
                "nonuniform: a random half of twice as many of these, with gaps and close pairs\n"
                "random: each anywhere, by area (default: poisson)",
                one_of({"poisson", "nonuniform", "random"}));
    line.option("--seed", line.common.seed, "N", "The same seed gives the same points (default: 0)",
                whole_number(0, INT64_MAX));
    o.outputs.declare(line, true);
}

gaussmap::SamplingMethod method_of(const std::string& name) {
    using gaussmap::SamplingMethod;
    return name == "random"    ? SamplingMethod::random
           : name == "poisson" ? SamplingMethod::poisson
                               : SamplingMethod::nonuniform;
}

bool is_colour(const Property& property) {
    const auto names = {"red", "green", "blue", "alpha"};
    return std::find(names.begin(), names.end(), property.name) != names.end();
}

/// Values at the corners of the greatest weight.
std::vector<double> nearest_corners(const SurfacePoints& at, const Geometry& mesh, const Property& property) {
    std::vector<double> values;
    for (std::size_t i = 0; i < at.count(); ++i) {
        const auto weights = at.weights.begin() + static_cast<std::ptrdiff_t>(3 * i);
        const auto corner = static_cast<std::size_t>(std::max_element(weights, weights + 3) - weights);
        values.push_back(
            property.at(static_cast<std::size_t>(mesh.faces[3 * static_cast<std::size_t>(at.face[i]) + corner])));
    }
    return values;
}

/// The cloud of the points; what it cannot carry is added to the notes.
Geometry cloud_of(const SurfacePoints& at, const Geometry& mesh) {
    using gaussmap::Type;
    Geometry cloud;
    cloud.vertices = at.points;
    cloud.vertex_type = mesh.vertex_type;
    cloud.normal_type = mesh.normal_type;
    cloud.notes = mesh.notes;
    if (has_normals(mesh)) cloud.normals = gaussmap::interpolate_normals(at, mesh.faces, mesh.normals);
    std::vector<std::string> lost;
    for (const Property& property : mesh.vertex_properties) {
        if (property.list) {
            lost.push_back(property.name);
            continue;
        }
        const bool continuous = property.type == Type::float32 || property.type == Type::float64 || is_colour(property);
        const std::vector<double> values = continuous ? gaussmap::interpolate(at, mesh.faces, property.as_double())
                                                      : nearest_corners(at, mesh, property);
        cloud.vertex_properties.push_back(gaussmap::make_property(property.name, values, property.type));
    }
    for (const Property& property : mesh.face_properties) lost.push_back(property.name + " of the faces");
    if (!lost.empty()) cloud.notes.push_back(fmt::format("points do not carry {}", listed(lost)));
    return cloud;
}

Table table_of(const Json& report) {
    Table table;
    table.add("read", count(report["vertices"].get<std::size_t>(), "vertex", "vertices") + ", " +
                          count(report["faces"].get<std::size_t>(), "face", "faces"));
    table.add("points", fmt::format("{}, {}, seed {}", count(report["points"].get<std::size_t>()),
                                    report["method"].get<std::string>(), report["seed"].get<std::uint64_t>()));
    add_ending(table, report);
    return table;
}

}  // namespace

void sample(int argc, char** argv) {
    Options o;
    CommandLine line("sample MESH -o OUT… [options]", about, examples);
    declare(line, o);
    if (!line.parse(argc, argv)) return;
    o.outputs.check(line);

    Stopwatch watch;
    const Geometry mesh = read_input(o.input, line.common);
    taken_as_mesh("mesh", mesh, o.input);  // refuses a cloud
    const double reading = watch.lap();
    const Geometry cloud = concerning(o.input, [&] {
        Progress progress("sampling", line.common.quiet);
        const SurfacePoints at =
            gaussmap::sample_surface(mesh.vertices, mesh.faces, o.count,
                                     {method_of(o.method), line.common.seed, progress.run(line.common.threads)});
        return cloud_of(at, mesh);
    });
    o.outputs.check_fit(cloud);
    const double sampling = watch.lap();
    o.outputs.write(cloud);

    Json report = {{"file", o.input}, {"vertices", mesh.vertex_count()}, {"faces", mesh.face_count()}};
    report["points"] = cloud.vertex_count();
    report["method"] = o.method;
    report["seed"] = line.common.seed;
    report["threads"] = line.common.threads;
    report["seconds"] = {{"read", reading}, {"sample", sampling}, {"write", watch.lap()}, {"total", watch.total()}};
    report_written(report, o.outputs, cloud);
    present(report, o.input + ": sample", table_of(report), line.common);
}

}  // namespace cli
