// Total curvature of real clouds: a result, with what is undefined told.
#include "clouds.h"
#include "gaussmap/curvature.h"
#include "gaussmap/io.h"

using namespace gaussmap;

namespace {

struct Measured {
    Geometry cloud;
    CloudCurvature result;
};

Measured run_on(const char* file, bool given) {
    Measured run;
    run.cloud = read((support::data_folder() / file).string());
    const Points points(run.cloud.vertices);
    EXPECT_EQ(run.cloud.normals.empty(), !given) << file;
    CloudCurvatureOptions options;
    options.estimator = Estimator::dirichlet;
    options.method = CloudNormals::pca;
    run.result = cloud_curvature(points, given ? Points(run.cloud.normals) : Points(), options);
    std::size_t bad = 0, finite = 0;
    for (const double density : run.result.density) (std::isnan(density) ? bad : finite) += 1;
    EXPECT_EQ(bad, run.result.undefined) << file;
    EXPECT_GT(finite, 0u) << file;
    for (const double density : run.result.density) EXPECT_FALSE(density < 0 || std::isinf(density)) << file;
    return run;
}

}  // namespace

TEST(CloudCurvatureReal, LionWithItsNormals) {
    NEED_DATA();
    const Measured run = run_on("large/lion_takanawa.ply", true);
    EXPECT_EQ(run.result.density.size(), 272768u);
    EXPECT_EQ(run.result.duplicates, 6u);
    EXPECT_LT(run.result.undefined, 100u);
}

TEST(CloudCurvatureReal, TurtleWithoutNormals) {
    NEED_DATA();
    const Measured run = run_on("clouds/cturtle.pcd", false);
    EXPECT_EQ(run.result.undefined, 0u);
    EXPECT_GT(run.result.boundary, 0u);
}

TEST(CloudCurvatureReal, RoomOfWhichHalfIsDuplicate) {
    NEED_DATA();
    const Measured run = run_on("clouds/room_scan1.pcd", false);
    EXPECT_GT(run.result.duplicates, run.cloud.vertex_count() / 3);
    EXPECT_EQ(run.result.undefined, 0u);
}

TEST(CloudCurvatureReal, TableOfWhichAThirdIsNotFinite) {
    NEED_DATA();
    const Measured run = run_on("clouds/table_scene_mug_stereo_textured.pcd", false);
    EXPECT_GT(run.result.non_finite, run.cloud.vertex_count() / 4);
    EXPECT_EQ(run.result.undefined, run.result.non_finite);
}
