// gaussmap: the command line. Chooses the verb, and turns every way a run can end into one line and an exit code.
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "console.h"
#include "gaussmap/io.h"
#include "outcome.h"
#include "verbs.h"

namespace cli {
namespace {

struct Verb {
    const char* name;
    const char* usage;
    const char* about;
    void (*run)(int argc, char** argv);
};

constexpr Verb verbs[] = {
    {"curvature", "IN [-o OUT]…", "total curvature of a mesh or a point cloud", curvature},
    {"normals", "IN -o OUT", "unit normals of a mesh, or of a cloud, oriented", normals},
    {"decimate", "IN -o OUT", "fewer triangles for the same surface, features kept", decimate},
    {"compare", "A B", "distances between two meshes or clouds, both ways", compare},
    {"sample", "MESH -o OUT", "points on a mesh: Poisson-disk, nonuniform, random", sample},
    {"shape", "NAME -o OUT", "analytic surfaces with exact normals and curvature", shape},
    {"view", "IN [IN2] -o OUT", "a page or a picture of the curvature, or other values", view},
    {"convert", "IN -o OUT", "another format; weld, triangulate", convert},
    {"info", "IN", "what a file holds, and what is wrong with it", info},
};

std::string help() {
    std::string page =
        "Examples:\n"
        "  gaussmap curvature bunny.ply                   measure and report\n"
        "  gaussmap curvature bunny.ply -o out.ply --color\n"
        "                                                 and write it, to look at\n"
        "  gaussmap curvature scan.pcd -o scan.ply --json for a script\n"
        "  gaussmap view bunny.ply -o bunny.html          a page to look at it\n"
        "  gaussmap shape torus -o torus.ply              a surface to try it on\n"
        "  gaussmap info broken.stl                       what is in a file\n"
        "\n"
        "gaussmap measures how much a surface bends: the total curvature k1² + k2² of\n"
        "triangle meshes and point clouds, from the variation of their normals.\n"
        "Its unit is 1/length², with the length unit of the file. Where it is undefined\n"
        "(a point of no face, too few neighbours) it is NaN, and counted.\n"
        "\n"
        "Verbs:\n";
    for (const Verb& verb : verbs) page += fmt::format("  {:<10}{:<15}  {}\n", verb.name, verb.usage, verb.about);
    page += fmt::format(
        "\n"
        "gaussmap VERB --help   examples and options of a verb\n"
        "gaussmap --version     which one this is\n"
        "\n"
        "Reads and writes {}.\n"
        "Reports go to standard error, JSON (--json) and -o - to standard output.\n"
        "Exit codes: 0 done, 1 failed while running, 2 wrong usage, 3 bad input.\n",
        gaussmap::known_extensions());
    return page;
}

/// \throw Failure and whatever the work throws.
void dispatch(int argc, char** argv) {
    const std::string_view word = argv[1];
    if (word == "--help" || word == "-h" || word == "help") return put(help());
    if (word == "--version") return put("gaussmap " GAUSSMAP_VERSION "\n");
    for (const Verb& verb : verbs)
        if (word == verb.name) return verb.run(argc, argv);
    if (word.starts_with('-'))
        throw Failure(Exit::wrong_usage, fmt::format("unknown option '{}'{}; options come after the verb", word,
                                                     did_you_mean(word, {"--help", "--version"})));
    std::vector<std::string> names;
    for (const Verb& verb : verbs) names.push_back(verb.name);
    const std::string hint = did_you_mean(word, names);
    throw Failure(Exit::wrong_usage,
                  fmt::format("unknown verb '{}'{}", word,
                              hint.empty() ? fmt::format("; the verbs are {}", fmt::join(names, ", ")) : hint));
}

}  // namespace
}  // namespace cli

int main(int argc, char** argv) {
    cli::catch_signals();
    if (argc < 2) {
        cli::say(cli::help());
        return static_cast<int>(cli::Exit::wrong_usage);
    }
    return static_cast<int>(cli::outcome_of(cli::dispatch, argc, argv));
}
