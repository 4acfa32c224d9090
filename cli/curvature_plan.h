// What `gaussmap curvature` is asked for, and what that comes to for its input.
#pragma once

#include <string>
#include <vector>

#include "files.h"
#include "gaussmap/curvature.h"

namespace cli {

struct CurvatureOptions {
    std::string input;
    Outputs outputs;
    std::string as = "auto", normals = "auto", estimator, orient = "local", truth;
    int k = 20, degree = 0;
    bool tensor = false, confidence = false, choice = false, color = false;

    void declare(CommandLine& line);
};

struct CurvaturePlan {
    bool mesh = false;
    bool file_normals = false;
    bool mesh_normals = false;  ///< regression is to be on those that --normals names
    std::string normals;        ///< how they come about, for the report: "file", "max", "jet 4", "fitted"
    gaussmap::MeshCurvatureOptions of_mesh;
    gaussmap::CloudCurvatureOptions of_cloud;
    std::vector<std::string> notes;

    gaussmap::Estimator estimator() const { return mesh ? of_mesh.estimator : of_cloud.estimator; }
    bool automatic_cloud() const { return !mesh && of_cloud.estimator == gaussmap::Estimator::automatic; }
    /// Whether k neighbours are what it is measured with.
    bool takes_k() const {
        const bool fits = estimator() == gaussmap::Estimator::jet || estimator() == gaussmap::Estimator::regression;
        return fits || (!mesh && !automatic_cloud());
    }
};

/// \throw Failure where the options do not fit the input.
CurvaturePlan plan_curvature(const CurvatureOptions& o, const CommandLine& line, const gaussmap::Geometry& geometry);

}  // namespace cli
