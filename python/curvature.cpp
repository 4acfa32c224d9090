// curvature.h and normals.h for Python.
#include "gaussmap/curvature.h"

#include <algorithm>
#include <limits>

#include "arrays.h"
#include "bindings.h"
#include "execution.h"
#include "gaussmap/normals.h"
#include "gaussmap/picture.h"

namespace binding {
namespace {

using namespace nb::literals;

gaussmap::Estimator estimator_named(const std::string& name) {
    using gaussmap::Estimator;
    return named<Estimator>("estimator", name,
                            {{"auto", Estimator::automatic},
                             {"dirichlet", Estimator::dirichlet},
                             {"corrected", Estimator::corrected},
                             {"regression", Estimator::regression},
                             {"jet", Estimator::jet}});
}

gaussmap::NormalWeights weights_named(const std::string& name) {
    using gaussmap::NormalWeights;
    return named<NormalWeights>(
        "normals", name, {{"max", NormalWeights::max}, {"angle", NormalWeights::angle}, {"area", NormalWeights::area}});
}

gaussmap::CloudNormals method_named(const std::string& name) {
    using gaussmap::CloudNormals;
    return named<CloudNormals>(
        "normals", name,
        {{"jet", CloudNormals::jet}, {"pca", CloudNormals::pca}, {"wpca", CloudNormals::weighted_pca}});
}

gaussmap::Orientation orientation_named(const std::string& name) {
    using gaussmap::Orientation;
    return named<Orientation>("orient", name,
                              {{"local", Orientation::local}, {"mst", Orientation::mst}, {"none", Orientation::none}});
}

nb::object tensor_of(gaussmap::PrincipalCurvatures&& tensor) {
    if (tensor.k1.empty()) return nb::none();
    return nb::make_tuple(array(std::move(tensor.k1)), array(std::move(tensor.k2)),
                          array(std::move(tensor.direction), 3));
}

Record mesh_curvature(const PointArray& vertices, const FaceArray& faces, const std::optional<PointArray>& normals,
                      const std::string& estimator, const std::string& weights, int k, int degree, bool tensor,
                      bool confidence, int threads, const nb::object& progress) {
    gaussmap::MeshCurvatureOptions options;
    options.estimator = estimator_named(estimator);
    options.weights = weights_named(weights);
    options.k = k;
    options.degree = degree;
    options.tensor = tensor;
    options.confidence = confidence;
    auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        options.run = run;
        return gaussmap::mesh_curvature(points(vertices), triangles(faces), points(normals), options);
    });
    Record out;
    out["density"] = array(std::move(found.density));
    out["kappa"] = array(std::move(found.kappa));
    out["face_density"] = array(std::move(found.face_density));
    out["normals"] = array(std::move(found.normals), 3);
    out["tensor"] = tensor_of(std::move(found.vertex_tensor));
    out["face_tensor"] = tensor_of(std::move(found.face_tensor));
    out["error"] = array_or_none(std::move(found.error));
    out["choice"] = array_or_none(std::move(found.choice));
    out["kappa_sum"] = found.kappa_sum;
    out["undefined"] = found.undefined;
    out["undefined_faces"] = found.undefined_faces;
    out["degenerate_faces"] = found.degenerate_faces;
    out["lowered"] = found.lowered;
    return out;
}

Record cloud_curvature(const PointArray& cloud, const std::optional<PointArray>& normals, const std::string& estimator,
                       int k, const std::string& method, int degree, const std::string& orient, bool tensor,
                       bool confidence, int threads, const nb::object& progress) {
    gaussmap::CloudCurvatureOptions options;
    options.estimator = estimator_named(estimator);
    options.k = k;
    options.method = method_named(method);
    options.degree = degree;
    options.orientation = orientation_named(orient);
    options.tensor = tensor;
    options.confidence = confidence;
    auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        options.run = run;
        return gaussmap::cloud_curvature(points(cloud), points(normals), options);
    });
    Record out;
    out["density"] = array(std::move(found.density));
    out["kappa"] = array_or_none(std::move(found.kappa));
    out["normals"] = array(std::move(found.normals), 3);
    out["tensor"] = tensor_of(std::move(found.tensor));
    out["error"] = array_or_none(std::move(found.error));
    out["choice"] = array_or_none(std::move(found.choice));
    out["undefined"] = found.undefined;
    out["duplicates"] = found.duplicates;
    out["non_finite"] = found.non_finite;
    out["boundary"] = found.boundary;
    out["lowered"] = found.lowered;
    return out;
}

nb::any mesh_normals(const PointArray& vertices, const FaceArray& faces, const std::string& weights, int threads,
                     const nb::object& progress) {
    const auto kind = weights_named(weights);
    return array(released(threads, progress,
                          [&](const gaussmap::Execution& run) {
                              return gaussmap::mesh_normals(points(vertices), triangles(faces), kind, run);
                          }),
                 3);
}

/// Normals of the distinct points, handed to every point at the position of one, as `gaussmap normals` does.
Record cloud_normals(const PointArray& cloud, int k, const std::string& method, int degree, bool oriented, int threads,
                     const nb::object& progress) {
    const auto kind = method_named(method);
    std::vector<double> normals(3 * cloud.shape(0), std::numeric_limits<double>::quiet_NaN());
    gaussmap::DistinctPoints distinct;
    const std::size_t lowered = released(threads, progress, [&](const gaussmap::Execution& run) {
        distinct = gaussmap::distinct_points(points(cloud));
        const auto neighbors = gaussmap::nearest_neighbors(distinct.points, k, run);
        auto fitted = gaussmap::cloud_normals(distinct.points, neighbors, {kind, degree, run});
        if (oriented) gaussmap::orient_normals(distinct.points, neighbors, fitted.normals, run);
        for (std::size_t i = 0; i < distinct.target.size(); ++i)
            if (distinct.target[i] >= 0) std::copy_n(&fitted.normals[3 * distinct.target[i]], 3, &normals[3 * i]);
        return fitted.lowered;
    });
    Record out;
    out["normals"] = array(std::move(normals), 3);
    out["lowered"] = lowered;
    out["duplicates"] = distinct.duplicates;
    out["non_finite"] = distinct.non_finite;
    return out;
}

using ValueArray = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

nb::any colors(const ValueArray& values, bool diverging) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * values.shape(0));
    for (std::size_t i = 0; i < values.shape(0); ++i) {
        const double value = values.data()[i];
        const auto color = diverging ? gaussmap::diverging_color_at(value) : gaussmap::color_at(value);
        rgb.insert(rgb.end(), color.begin(), color.end());
    }
    return array(std::move(rgb), 3);
}

}  // namespace

void bind_curvature(nb::module_& m) {
    m.def("mesh_curvature", mesh_curvature, "vertices"_a.noconvert(), "faces"_a.noconvert(),
          "normals"_a.noconvert().none(), "estimator"_a, "weights"_a, "k"_a, "degree"_a, "tensor"_a, "confidence"_a,
          "threads"_a, "progress"_a.none());
    m.def("cloud_curvature", cloud_curvature, "points"_a.noconvert(), "normals"_a.noconvert().none(), "estimator"_a,
          "k"_a, "method"_a, "degree"_a, "orient"_a, "tensor"_a, "confidence"_a, "threads"_a, "progress"_a.none());
    m.def(
        "choice_name", [](std::uint8_t choice) { return std::string(gaussmap::choice_name(choice)); }, "choice"_a);
    m.def("mesh_normals", mesh_normals, "vertices"_a.noconvert(), "faces"_a.noconvert(), "weights"_a, "threads"_a,
          "progress"_a.none());
    m.def("cloud_normals", cloud_normals, "points"_a.noconvert(), "k"_a, "method"_a, "degree"_a, "oriented"_a,
          "threads"_a, "progress"_a.none());
    m.def("colors", colors, "values"_a.noconvert(), "diverging"_a);
}

}  // namespace binding
