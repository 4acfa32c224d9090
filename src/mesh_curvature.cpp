// Total curvature of a mesh: normals where none are given, the fused pass, and what happened.
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "check.h"
#include "check_cloud.h"
#include "clock.h"
#include "corrected_curvature.h"
#include "estimators.h"
#include "fitted_mesh.h"
#include "gaussmap/curvature.h"
#include "normalize.h"
#include "parallel.h"
#include "shape_operator.h"
#include "vertex_density.h"
#include "weighted_normals.h"

namespace gaussmap {
namespace {

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

void check(const MeshCurvatureOptions& options) {
    check_estimator(options.estimator, Input::mesh, options.confidence);
    if (options.estimator == Estimator::jet) check_jet(options.k, options.degree);
    if (options.estimator == Estimator::regression && options.k < 3)
        throw std::invalid_argument("k = " + std::to_string(options.k) +
                                    " is too small; estimator = regression takes at least 3 neighbours");
    if (options.estimator == Estimator::jet || options.estimator == Estimator::regression) check_degree(options.degree);
}

}  // namespace

MeshCurvature mesh_curvature(Points vertices, Triangles faces, Points normals, const MeshCurvatureOptions& options) {
    check(options);
    if (!normals.empty()) check_count("normals", normals.count, vertices.count, "vertices");
    const bool fits = options.estimator != Estimator::dirichlet && options.estimator != Estimator::corrected;
    MeshCurvature result;
    auto start = Clock::now();
    const FaceChunks chunks = chunk_faces(faces, vertices.count, {options.run.threads, {}});
    if (normals.empty()) {
        result.normals =
            weighted_normals(vertices, faces, chunks, options.weights, part_of(options.run, 0, fits ? 0.05 : 0.5));
    } else {
        result.normals.assign(normals.xyz, normals.xyz + 3 * normals.count);
        normalize(result.normals, options.run);
    }
    result.seconds_normals = seconds_since(start);

    start = Clock::now();
    if (fits) {
        MeshCurvatureOptions fitting = options;
        fitting.run = part_of(options.run, 0.05, 0.5);
        fitted_mesh(vertices, faces, !normals.empty(), fitting, result);
    }
    const auto sums = std::make_unique_for_overwrite<double[]>(2 * vertices.count);
    result.kappa.resize(faces.count);
    result.face_density.resize(faces.count);
    fused_pass(vertices, faces, chunks, result.normals, sums.get(), result.kappa.data(), result.face_density.data(),
               part_of(options.run, 0.5, options.tensor ? 0.7 : 1));
    count_faces(result);
    if (options.estimator == Estimator::corrected) {
        result.density = corrected_density(vertices, faces, result.normals, {options.run.threads, {}});
    } else if (!fits) {
        divide_sums(sums.get(), vertices.count, options.run);
        result.density.resize(vertices.count);
        for (std::size_t v = 0; v < vertices.count; ++v) result.density[v] = sums[2 * v];
    }
    if (options.tensor) {
        if (!fits)
            result.vertex_tensor = vertex_tensor(vertices, faces, result.normals, part_of(options.run, 0.7, 0.9));
        result.face_tensor = face_tensor(vertices, faces, result.normals, part_of(options.run, 0.9, 1));
    }
    for (const double d : result.density) result.undefined += std::isnan(d);
    result.seconds_curvature = seconds_since(start);
    return result;
}

}  // namespace gaussmap
