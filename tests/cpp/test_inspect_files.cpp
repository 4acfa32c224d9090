// Counts of real files against those in the notes of MANIFEST.tsv, which other programs made:
// "open(N boundary edges) nonmanifold(eN vN) flip=N degen=N dupv=N comps=N iso=N dupf=N", what is 0 (comps: 1) left
// out.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include "gaussmap/inspect.h"
#include "gaussmap/io.h"
#include "support.h"

namespace {

std::size_t noted(const std::string& notes, const char* pattern, std::size_t otherwise = 0) {
    std::smatch match;
    return std::regex_search(notes, match, std::regex(pattern)) ? std::stoul(match[1]) : otherwise;
}

/// Where the manifest counts something else, with the reason.
const std::map<std::string, std::string> different = {
    {"meshes/classic/teapot.obj comps", "parts that touch at a vertex are one there"},
    {"nasty/cheese-selection-2.off comps", "parts that touch at a vertex are one there"},
    {"nasty/cycloidal.ply comps", "parts that touch at a vertex are one there"},
    {"nasty/Offset1.obj degen", "slivers of height 1e-12 of their length are degenerate there"},
};

TEST(RealFiles, HaveTheCountsOfTheManifest) {
    NEED_DATA();
    std::ifstream manifest(support::data_folder() / "MANIFEST.tsv");
    std::string line;
    std::size_t compared = 0;
    while (std::getline(manifest, line)) {
        const std::string path = line.substr(0, line.find('\t')), notes = line.substr(line.rfind('\t') + 1);
        const bool counted = std::regex_search(notes, std::regex(" (closed|open\\()"));
        if (!counted || std::filesystem::file_size(support::data_folder() / path) > 4'000'000) continue;
        gaussmap::Geometry geometry;
        try {
            geometry = gaussmap::read(support::data_folder() / path);
        } catch (const gaussmap::FormatError&) {
            continue;  // files that are broken on purpose are test_io's
        }
        if (!geometry.polygons.empty()) continue;  // the manifest counts polygons whole
        const gaussmap::Inspection found = gaussmap::inspect(geometry.vertices, geometry.faces);
        const auto expect = [&](const char* what, std::size_t value, std::size_t expected) {
            const auto reason = different.find(path + ' ' + what);
            if (reason == different.end()) {
                EXPECT_EQ(value, expected) << path << ' ' << what;
            } else {
                EXPECT_NE(value, expected) << path << ' ' << what << ", no longer: " << reason->second;
            }
        };
        expect("open", found.boundary_edges, noted(notes, "open\\((\\d+)\\)"));
        expect("e", found.non_manifold_edges, noted(notes, "nonmanifold\\(e(\\d+)"));
        expect("v", found.non_manifold_vertices, noted(notes, "nonmanifold\\(e\\d+ v(\\d+)"));
        expect("flip", found.inconsistent_edges, noted(notes, "flip=(\\d+)"));
        expect("degen", found.degenerate_faces, noted(notes, "degen=(\\d+)"));
        expect("dupv", found.duplicate_vertices, noted(notes, "dupv=(\\d+)"));
        expect("comps", found.components, noted(notes, "comps=(\\d+)", 1));
        expect("iso", found.isolated_vertices, noted(notes, "iso=(\\d+)"));
        expect("dupf", found.duplicate_faces, noted(notes, "dupf=(\\d+)"));
        ++compared;
    }
    EXPECT_GT(compared, 50u);
}

}  // namespace
