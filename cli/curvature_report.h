// What `gaussmap curvature` found: its results, its JSON, its table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "curvature_plan.h"
#include "report.h"

namespace cli {

/// One value a vertex or point, but for those of the faces.
struct Measured {
    std::vector<double> density, kappa, face_density, normals, error;
    gaussmap::PrincipalCurvatures tensor, face_tensor;
    std::vector<std::uint8_t> choice;
    double kappa_sum = 0;
    double seconds_neighbors = 0, seconds_normals = 0, seconds_curvature = 0;
    Json counts;  ///< of what is undefined, degenerate, …
};

/// All but the times, the memory, the outputs and the notes, which the end of the run adds.
/// \param truth  one a vertex, or empty.
Json curvature_report(const CurvatureOptions& o, const CurvaturePlan& plan, const gaussmap::Geometry& geometry,
                      const Measured& measured, const std::vector<double>& truth, int threads);

std::string curvature_title(const Json& report);
Table curvature_table(const Json& report);

}  // namespace cli
