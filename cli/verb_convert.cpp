// gaussmap convert: another format, attributes kept where it has a place for them.
#include <fmt/format.h>

#include "files.h"
#include "report.h"
#include "verbs.h"

namespace cli {
namespace {

constexpr const char* about =
    "Writes a mesh or a cloud in another format. Normals, colours, other values of vertices and faces, polygons and "
    "comments are kept where the format has a place for them, as .ply has for all; what is lost is told.";

constexpr const char* examples =
    "gaussmap convert part.stl -o part.ply --weld      triangles of an STL joined\n"
    "gaussmap convert quads.obj -o tris.ply --triangulate\n"
    "gaussmap convert scan.pcd -o scan.xyz             a table of text\n"
    "gaussmap convert - -o - --format off < in.ply     in a pipe";

Json report_on(const std::string& path, const gaussmap::Geometry& before, const gaussmap::Geometry& after) {
    Json report = {{"file", path}, {"kind", after.faces.empty() ? "cloud" : "mesh"}};
    report["vertices_in"] = before.vertex_count();
    report["faces_in"] = before.face_count();
    report["vertices"] = after.vertex_count();
    report["faces"] = after.face_count();
    report["polygons"] = after.polygons.empty() ? Json() : Json(after.polygons.count());
    return report;
}

}  // namespace

void convert(int argc, char** argv) {
    CommandLine line("convert IN -o OUT… [options]", about, examples);
    std::string path;
    Outputs outputs;
    bool weld = false, triangulate = false;
    line.input(path, "IN", "A mesh or a cloud: " + gaussmap::known_extensions() + "; - is standard input");
    line.group("Changes");
    line.flag("--weld", weld, "Join vertices at exactly the same position (the values of the first are kept)");
    line.flag("--triangulate", triangulate, "Write triangles instead of polygons");
    outputs.declare(line, true);
    if (!line.parse(argc, argv)) return;
    outputs.check(line);

    Stopwatch watch;
    const gaussmap::Geometry before = read_input(path, line.common);
    const double reading = watch.lap();
    gaussmap::Geometry after = weld ? gaussmap::weld(before) : before;
    if (triangulate) after = gaussmap::triangulate(after);
    outputs.check_fit(after);
    Json report = report_on(path, before, after);
    outputs.write(after);
    std::vector<std::string> notes = after.notes;
    for (const std::string& loss : outputs.losses(after)) notes.push_back(loss);

    report["seconds"] = {{"read", reading}, {"write", watch.lap()}, {"total", watch.total()}};
    report["peak_bytes"] = peak_bytes();
    report["outputs"] = outputs.paths;
    report["notes"] = notes;
    Table table;
    table.add("read", fmt::format("{}, {}", count(before.vertex_count(), "vertex", "vertices"),
                                  count(before.face_count(), "face", "faces")));
    for (const std::string& out : outputs.paths)
        table.add("wrote", fmt::format("{}: {}, {}", out, count(after.vertex_count(), "vertex", "vertices"),
                                       count(after.face_count(), "face", "faces")));
    present(report, path, table, line.common);
}

}  // namespace cli
