#include "decimation_error.h"

#include <algorithm>
#include <cmath>

#include "gaussmap/distance.h"
#include "gaussmap/neighbors.h"
#include "parallel.h"
#include "surface_samples.h"

namespace gaussmap {
namespace {

constexpr std::size_t samples = 100000, block = 2048;

/// Distance of each place from the input.
std::vector<double> distances(const FaceBoxes& fine, Points places, const Execution& run) {
    std::vector<double> distance(places.count);
    const std::vector<std::int32_t> order = spatial_order(places, run);
    for_blocks(places.count, block, run, [&](std::size_t, std::size_t i, std::size_t end) {
        for (std::int32_t face = -1; i < end; ++i) {
            const Vec3 p = load(places[order[i]]);
            const FaceHit found = closest_face(fine, p, hit_of(fine, face, p));
            face = found.face;
            distance[order[i]] = std::sqrt(found.squared);
        }
    });
    return distance;
}

}  // namespace

DecimationError decimation_error(const DecimationInput& in, const FaceBoxes& fine, Points vertices, Triangles faces,
                                 const Execution& run) {
    const SurfaceSamples back = surface_samples(vertices, faces, samples, 0, run);
    const Deviation from_made = deviation_of(distances(fine, back.points, run), back.counts);
    const SurfaceSamples there = surface_samples(in.points(), in.corners, samples, 0, run);
    const Deviation from_input =
        deviation_of(ClosestIndex(vertices, faces, run).distances(there.points, run), there.counts);
    return {std::max(from_made.max, from_input.max), std::max(from_made.rms, from_input.rms)};
}

}  // namespace gaussmap
