// decimate.h, distance.h and sampling.h for Python.
#include <algorithm>

#include "arrays.h"
#include "bindings.h"
#include "execution.h"
#include "gaussmap/decimate.h"
#include "gaussmap/distance.h"
#include "gaussmap/sampling.h"

namespace binding {
namespace {

using namespace nb::literals;

using CornerValues = nb::ndarray<const double, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Seams = nb::ndarray<const std::uint8_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

/// (faces, weights) of points of a surface, or None where there are none.
nb::object surface_points(const std::vector<gaussmap::SurfacePoint>& at) {
    if (at.empty()) return nb::none();
    std::vector<std::int32_t> faces;
    std::vector<double> weights;
    faces.reserve(at.size());
    weights.reserve(3 * at.size());
    for (const gaussmap::SurfacePoint& point : at) {
        faces.push_back(point.face);
        weights.insert(weights.end(), point.weights.begin(), point.weights.end());
    }
    return nb::make_tuple(array(std::move(faces)), array(std::move(weights), 3));
}

gaussmap::DecimationMethod method_of(const std::string& name) {
    using gaussmap::DecimationMethod;
    return named<DecimationMethod>(
        "method", name,
        {{"best", DecimationMethod::best}, {"qem", DecimationMethod::qem}, {"edge", DecimationMethod::edge}});
}

gaussmap::DecimationObjective objective_of(const std::string& name) {
    using gaussmap::DecimationObjective;
    return named<DecimationObjective>(
        "objective", name,
        {{"both", DecimationObjective::both}, {"rms", DecimationObjective::rms}, {"max", DecimationObjective::max}});
}

Record decimate(const PointArray& vertices, const FaceArray& faces, std::size_t target, double error,
                const std::string& method, const std::string& objective, bool weights, bool fast,
                bool preserve_boundary, bool lock_border, double feature_angle, bool allow_topology, bool sources,
                const std::optional<Seams>& seams, int threads, const nb::object& progress) {
    gaussmap::DecimateOptions options;
    options.faces = target;
    options.error = error;
    options.method = method_of(method);
    options.objective = objective_of(objective);
    options.weights = weights;
    options.fast = fast;
    options.preserve_boundary = preserve_boundary;
    options.lock_border = lock_border;
    options.feature_angle = feature_angle;
    options.allow_topology = allow_topology;
    options.sources = sources;
    if (seams) options.seams.assign(seams->data(), seams->data() + seams->size());
    auto made = released(threads, progress, [&](const gaussmap::Execution& run) {
        options.run = run;
        return gaussmap::decimate(points(vertices), triangles(faces), options);
    });
    Record out;
    out["vertices"] = array(std::move(made.vertices), 3);
    out["faces"] = array(std::move(made.faces), 3);
    out["face_source"] = array(std::move(made.face_source));
    out["vertex_source"] = surface_points(made.vertex_source);
    out["corner_source"] = surface_points(made.corner_source);
    out["reached"] = made.stop == gaussmap::DecimationStop::target;
    out["error_bound"] = made.error_bound;
    out["degenerate"] = made.degenerate;
    out["non_finite"] = made.non_finite;
    out["refused_locked"] = made.refused_locked;
    out["refused_topology"] = made.refused_topology;
    out["refused_folding"] = made.refused_folding;
    return out;
}

/// (m, 3) of the values of corners, (m, 3 × components), or None where there is no seam.
nb::any corner_seams(const FaceArray& faces, const CornerValues& values) {
    auto seams =
        gaussmap::corner_seams(triangles(faces), {values.data(), values.data() + values.size()}, values.shape(1) / 3);
    return seams.empty() ? nb::steal<nb::any>(nb::none().release()) : array(std::move(seams), 3);
}

nb::tuple deviation(const gaussmap::Deviation& way) {
    return nb::make_tuple(way.max, way.rms, way.mean);
}

std::size_t total(const gaussmap::SampleCounts& samples) {
    return samples.vertices + samples.edges + samples.faces;
}

Record surface_distance(const PointArray& a, const std::optional<FaceArray>& faces_a, const PointArray& b,
                        const std::optional<FaceArray>& faces_b, std::size_t samples, std::uint64_t seed, int threads,
                        const nb::object& progress) {
    const auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        return gaussmap::surface_distance(points(a), triangles(faces_a), points(b), triangles(faces_b),
                                          {samples, seed, run});
    });
    Record out;
    out["forward"] = deviation(found.forward);
    out["backward"] = deviation(found.backward);
    out["symmetric"] = deviation(found.symmetric);
    out["diagonal"] = found.diagonal;
    out["samples"] = total(found.forward_samples) + total(found.backward_samples);
    return out;
}

/// (lower, upper, (x, y, z), within_tolerance): from a to b, lengths.
Tuple hausdorff_bound(const PointArray& a, const std::optional<FaceArray>& faces_a, const PointArray& b,
                      const std::optional<FaceArray>& faces_b, double tolerance, int threads,
                      const nb::object& progress) {
    const auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        gaussmap::HausdorffOptions options;
        options.tolerance = tolerance;
        options.run = run;
        const gaussmap::ClosestIndex index(points(b), triangles(faces_b), run);
        return gaussmap::hausdorff_bound(points(a), triangles(faces_a), index, options);
    });
    return nb::make_tuple(found.lower, found.upper, nb::make_tuple(found.at[0], found.at[1], found.at[2]),
                          found.within_tolerance);
}

/// (distances, closest points, elements) of the queries.
Tuple closest(const PointArray& vertices, const std::optional<FaceArray>& faces, const PointArray& queries, int threads,
              const nb::object& progress) {
    auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        return gaussmap::ClosestIndex(points(vertices), triangles(faces), run).closest(points(queries), run);
    });
    return nb::make_tuple(array(std::move(found.distance)), array(std::move(found.points), 3),
                          array(std::move(found.element)));
}

gaussmap::SamplingMethod sampling_of(const std::string& name) {
    using gaussmap::SamplingMethod;
    return named<SamplingMethod>("method", name,
                                 {{"poisson", SamplingMethod::poisson},
                                  {"nonuniform", SamplingMethod::nonuniform},
                                  {"random", SamplingMethod::random}});
}

/// (points, faces, weights).
Tuple sample_surface(const PointArray& vertices, const FaceArray& faces, std::size_t count, const std::string& method,
                     std::uint64_t seed, int threads, const nb::object& progress) {
    const auto kind = sampling_of(method);
    auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        return gaussmap::sample_surface(points(vertices), triangles(faces), count, {kind, seed, run});
    });
    return nb::make_tuple(array(std::move(found.points), 3), array(std::move(found.face)),
                          array(std::move(found.weights), 3));
}

nb::any poisson_subset(const PointArray& candidates, double area, std::size_t count, int threads,
                       const nb::object& progress) {
    return array(released(threads, progress, [&](const gaussmap::Execution& run) {
        return gaussmap::poisson_subset(points(candidates), area, count, run);
    }));
}

}  // namespace

void bind_surfaces(nb::module_& m) {
    m.def("decimate", decimate, "vertices"_a.noconvert(), "faces"_a.noconvert(), "target"_a, "error"_a, "method"_a,
          "objective"_a, "weights"_a, "fast"_a, "preserve_boundary"_a, "lock_border"_a, "feature_angle"_a,
          "allow_topology"_a, "sources"_a, "seams"_a.noconvert().none(), "threads"_a, "progress"_a.none());
    m.def("corner_seams", corner_seams, "faces"_a.noconvert(), "values"_a.noconvert());
    m.def("surface_distance", surface_distance, "a"_a.noconvert(), "faces_a"_a.noconvert().none(), "b"_a.noconvert(),
          "faces_b"_a.noconvert().none(), "samples"_a, "seed"_a, "threads"_a, "progress"_a.none());
    m.def("hausdorff_bound", hausdorff_bound, "a"_a.noconvert(), "faces_a"_a.noconvert().none(), "b"_a.noconvert(),
          "faces_b"_a.noconvert().none(), "tolerance"_a, "threads"_a, "progress"_a.none());
    m.def("closest", closest, "vertices"_a.noconvert(), "faces"_a.noconvert().none(), "queries"_a.noconvert(),
          "threads"_a, "progress"_a.none());
    m.def("sample_surface", sample_surface, "vertices"_a.noconvert(), "faces"_a.noconvert(), "count"_a, "method"_a,
          "seed"_a, "threads"_a, "progress"_a.none());
    m.def("poisson_subset", poisson_subset, "candidates"_a.noconvert(), "area"_a, "count"_a, "threads"_a,
          "progress"_a.none());
}

}  // namespace binding
