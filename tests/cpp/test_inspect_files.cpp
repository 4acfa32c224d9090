// Counts of real files against those in the notes of MANIFEST.tsv, which other programs made:
// "open(N boundary edges) nonmanifold(eN vN) flip=N degen=N dupv=N comps=N iso=N dupf=N", what is 0 (comps: 1) left
// out.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "gaussmap/inspect.h"
#include "gaussmap/io.h"
#include "support.h"

namespace {

/// The number right after `key` in the notes.
std::size_t noted(const std::string& notes, const std::string& key, std::size_t otherwise = 0) {
    const std::size_t at = notes.find(key);
    return at == std::string::npos ? otherwise : std::stoul(notes.substr(at + key.size()));
}

/// Where the manifest counts something else, with the reason.
const std::map<std::string, std::string> different = {
    {"meshes/classic/teapot.obj comps", "parts that touch at a vertex are one there"},
    {"nasty/cheese-selection-2.off comps", "parts that touch at a vertex are one there"},
    {"nasty/cycloidal.ply comps", "parts that touch at a vertex are one there"},
    {"nasty/Offset1.obj degen", "what is tiny beside the whole mesh, well-shaped or not, is degenerate there"},
};

TEST(RealFiles, HaveTheCountsOfTheManifest) {
    NEED_DATA();
    std::ifstream manifest(support::data_folder() / "MANIFEST.tsv");
    std::string line;
    std::size_t compared = 0;
    while (std::getline(manifest, line)) {
        const std::string path = line.substr(0, line.find('\t')), notes = line.substr(line.rfind('\t') + 1);
        const bool counted = notes.find("— closed ") != notes.npos || notes.find("— open(") != notes.npos;
        if (!counted || std::filesystem::file_size(support::data_folder() / path) > 4'000'000) continue;
        gaussmap::Geometry geometry;
        try {
            geometry = gaussmap::read(support::data_folder() / path);
        } catch (const gaussmap::FormatError&) {
            continue;  // files that are broken on purpose are test_io's
        }
        if (!geometry.polygons.empty()) continue;  // the manifest counts polygons whole
        const gaussmap::Inspection found = gaussmap::inspect(geometry.vertices, geometry.faces);
        const std::size_t bad = notes.find("nonmanifold(e");
        const std::string bad_vertices = bad == notes.npos ? "" : notes.substr(bad);
        const auto expect = [&](const char* what, std::size_t value, std::size_t expected) {
            const auto reason = different.find(path + ' ' + what);
            if (reason == different.end()) {
                EXPECT_EQ(value, expected) << path << ' ' << what;
            } else {
                EXPECT_NE(value, expected) << path << ' ' << what << ", no longer: " << reason->second;
            }
        };
        expect("open", found.boundary_edges, noted(notes, "— open("));
        expect("e", found.non_manifold_edges, noted(notes, "nonmanifold(e"));
        expect("v", found.non_manifold_vertices, noted(bad_vertices, " v"));
        expect("flip", found.inconsistent_edges, noted(notes, " flip="));
        expect("degen", found.degenerate_faces, noted(notes, " degen="));
        expect("dupv", found.duplicate_vertices, noted(notes, " dupv="));
        expect("comps", found.components, noted(notes, " comps=", 1));
        expect("iso", found.isolated_vertices, noted(notes, " iso="));
        expect("dupf", found.duplicate_faces, noted(notes, " dupf="));
        ++compared;
    }
    EXPECT_GT(compared, 50u);
}

}  // namespace
