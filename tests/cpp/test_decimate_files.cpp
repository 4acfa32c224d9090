// Every real mesh to a tenth of its faces: valid, or one clear error in reading it.

#include <gtest/gtest.h>

#include <filesystem>

#include "gaussmap/decimate.h"
#include "gaussmap/distance.h"
#include "gaussmap/inspect.h"
#include "gaussmap/io.h"
#include "support.h"
#include "validity.h"

namespace {

using validity::counts_of;

void expect_valid(const std::vector<double>& xyz, const std::vector<std::int32_t>& faces, bool fast) {
    gaussmap::DecimateOptions options;
    options.faces = faces.size() / 30;
    options.fast = fast;
    const gaussmap::Decimation d = gaussmap::decimate(xyz, faces, options);
    const validity::Counts before = counts_of(xyz, faces), after = counts_of(d.vertices, d.faces);
    for (const double x : d.vertices) ASSERT_TRUE(std::isfinite(x));
    EXPECT_LE(after.crowded_sides, before.crowded_sides);
    EXPECT_LE(after.border_sides, before.border_sides);
    EXPECT_LE(after.degenerate, before.degenerate);
    EXPECT_LE(after.duplicates, before.duplicates);
    EXPECT_EQ(after.unused, 0u);
    EXPECT_EQ(after.parts, before.parts);
    const bool manifold = before.crowded_sides + before.unoriented == 0;
    if (manifold) {
        EXPECT_EQ(after.crowded_sides + after.unoriented, 0u);
        EXPECT_EQ(after.euler, before.euler);
    }
    if (d.stop == gaussmap::DecimationStop::target) {
        EXPECT_LE(d.faces.size() / 3, options.faces);
    } else {
        EXPECT_GT(d.refused_locked + d.refused_topology + d.refused_folding, 0u);
    }
    if (manifold && before.border_sides == 0 && before.parts == 1 && before.faces > 5000) {
        EXPECT_NEAR(after.volume, before.volume, 0.02 * std::abs(before.volume));
    }
}

TEST(RealFiles, ComeOutValid) {
    NEED_DATA();
    std::size_t meshes = 0;
    for (const char* folder : {"meshes", "nasty"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(support::data_folder() / folder)) {
            const std::uintmax_t largest = support::sanitized ? 200'000 : 1'700'000;  // larger ones: the bench
            if (!entry.is_regular_file() || entry.file_size() > largest) continue;
            SCOPED_TRACE(entry.path().string());
            gaussmap::Geometry g;
            try {
                g = gaussmap::read(entry.path());
            } catch (const gaussmap::FormatError&) { continue; }
            if (g.faces.empty()) continue;
            expect_valid(g.vertices, g.faces, g.face_count() > 8000);
            ++meshes;
        }
    EXPECT_GT(meshes, support::sanitized ? 55u : 80u);
}

TEST(RealFiles, LegsAndHornsOfTheCowStay) {
    NEED_DATA();
    // Costs that forget the first surface eat them: 0.020.
    const gaussmap::Geometry g = gaussmap::read(support::data_folder() / "meshes/classic/cow.obj");
    gaussmap::DecimateOptions options;
    options.faces = g.face_count() / 50;
    options.fast = true;
    const gaussmap::Decimation d = gaussmap::decimate(g.vertices, g.faces, options);
    gaussmap::DistanceOptions measure;
    measure.samples = 30000;
    const auto found = gaussmap::surface_distance(g.vertices, g.faces, d.vertices, d.faces, measure);
    EXPECT_LT(found.symmetric.rms, 0.013 * found.diagonal);
}

}  // namespace
