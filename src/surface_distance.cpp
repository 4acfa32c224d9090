// Two-sided distances from samples: every sample's exact closest point, summed up in blocks of a fixed size.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "bounding_box.h"
#include "closest_tree.h"
#include "parallel.h"
#include "surface_samples.h"

namespace gaussmap {
namespace {

Deviation deviation_from(Points vertices, Triangles faces, const ClosestIndex& to, const DistanceOptions& options,
                         SampleCounts& counts, const Execution& run) {
    const SurfaceSamples samples =
        surface_samples(vertices, faces, options.samples, options.seed, part_of(run, 0, 0.1));
    counts = samples.counts;
    return deviation_of(to.distances(samples.points, part_of(run, 0.1, 1)), counts);
}

void check_named(const char* name, Points vertices, Triangles faces) {
    try {
        check_surface(vertices, faces);
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(std::string(name) + ": " + error.what());
    }
}

}  // namespace

double box_diagonal(Points vertices, Triangles faces) {
    BoundingBox box;
    for_surface_points(vertices, faces, [&](Vec3 p) { box.include(p); });
    const Vec3 d = box.high - box.low;
    return box.empty() ? 0 : std::hypot(d.x, d.y, d.z);  // of boxes near the ends of the exponents too
}

SurfaceDistance surface_distance(Points a, Triangles faces_a, Points b, Triangles faces_b,
                                 const DistanceOptions& options) {
    const Execution& run = options.run;
    check_named("a", a, faces_a);
    check_named("b", b, faces_b);
    SurfaceDistance distance;
    const auto measure = [&](Points from, Triangles from_faces, Points to, Triangles to_faces, SampleCounts& counts,
                             const Execution& part) {
        const ClosestIndex index(to, to_faces, part_of(part, 0, 0.1));
        return deviation_from(from, from_faces, index, options, counts, part_of(part, 0.1, 1));
    };
    distance.forward = measure(a, faces_a, b, faces_b, distance.forward_samples, part_of(run, 0, 0.5));
    distance.backward = measure(b, faces_b, a, faces_a, distance.backward_samples, part_of(run, 0.5, 1));
    distance.symmetric = {std::max(distance.forward.max, distance.backward.max),
                          std::max(distance.forward.rms, distance.backward.rms),
                          std::max(distance.forward.mean, distance.backward.mean)};
    distance.diagonal = box_diagonal(a, faces_a);
    return distance;
}

}  // namespace gaussmap
