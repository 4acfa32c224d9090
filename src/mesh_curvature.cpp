// Total curvature of a mesh: normals where none are given, the fused pass, and what happened.
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "check.h"
#include "corrected_curvature.h"
#include "gaussmap/curvature.h"
#include "normalize.h"
#include "parallel.h"
#include "vertex_density.h"

namespace gaussmap {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The counts over faces, and the sum of kappa in the order of the faces.
void count_faces(MeshCurvature& result) {
    std::size_t undefined = 0, without_density = 0;
    double sum = 0;
    for (std::size_t f = 0; f < result.kappa.size(); ++f) {
        const double kappa = result.kappa[f];
        const bool defined = kappa == kappa;
        sum += defined ? kappa : 0;
        undefined += !defined;
        without_density += result.face_density[f] != result.face_density[f];
    }
    result.kappa_sum = sum;
    result.undefined_faces = undefined;
    result.degenerate_faces = without_density - undefined;
}

}  // namespace

MeshCurvature mesh_curvature(Points vertices, Triangles faces, Points normals, const MeshCurvatureOptions& options) {
    if (!normals.empty()) check_count("normals", normals.count, vertices.count, "vertices");
    MeshCurvature result;
    auto start = std::chrono::steady_clock::now();
    if (normals.empty()) {
        result.normals = mesh_normals(vertices, faces, options.weights, part_of(options.run, 0, 0.5));
    } else {
        result.normals.assign(normals.xyz, normals.xyz + 3 * normals.count);
        normalize(result.normals, options.run);
    }
    result.seconds_normals = seconds_since(start);

    start = std::chrono::steady_clock::now();
    const auto sums = std::make_unique_for_overwrite<double[]>(2 * vertices.count);
    result.kappa.resize(faces.count);
    result.face_density.resize(faces.count);
    fused_pass(vertices, faces, result.normals, sums.get(), result.kappa.data(), result.face_density.data(),
               part_of(options.run, 0.5, 1));
    count_faces(result);
    if (options.estimator == Estimator::corrected) {
        result.density = corrected_density(vertices, faces, result.normals, {options.run.threads, {}});
    } else {
        result.density.resize(vertices.count);
        for (std::size_t v = 0; v < vertices.count; ++v) {
            const double quotient = sums[2 * v] / sums[2 * v + 1];
            result.density[v] = sums[2 * v + 1] > 0 ? quotient : std::numeric_limits<double>::quiet_NaN();
        }
    }
    for (const double d : result.density) result.undefined += std::isnan(d);
    result.seconds_curvature = seconds_since(start);
    return result;
}

}  // namespace gaussmap
