// Points spread evenly over a surface, for measuring: on its vertices, along its edges, over its faces.
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/distance.h"
#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

/// Vertices first, then points on edges, then on faces.
struct SurfaceSamples {
    std::vector<double> points;
    SampleCounts counts;
};

/// All vertices of faces, `samples` points on faces and a quarter as many on edges, at equal steps of area and length;
/// none of those where the surface has no area or no length. Without faces: all vertices.
/// Of checked input. Time O(vertices + faces + samples).
SurfaceSamples surface_samples(Points vertices, Triangles faces, std::size_t samples, std::uint64_t seed,
                               const Execution& run);

/// Of the distances of all samples the maximum, of those on faces (else on edges, else of all) the mean and the root
/// mean square.
Deviation deviation_of(const std::vector<double>& distance, const SampleCounts& counts);

/// A point of the unit square that R_2, the sequence of Roberts (2018, "The unreasonable effectiveness of quasirandom
/// sequences"), visits after `step` steps, shifted: any few in a row are spread evenly.
struct SquarePoint {
    double u, v;
};
SquarePoint spread_out(std::uint64_t step, std::uint64_t shift);

/// The unit square folded onto its half u + v ≤ 1.
inline SquarePoint folded(SquarePoint at) {
    return at.u + at.v > 1 ? SquarePoint{1 - at.u, 1 - at.v} : at;
}

/// a + u (b − a) + v (c − a): even by area where the square is sampled evenly and folded.
inline Vec3 in_triangle(Vec3 a, Vec3 b, Vec3 c, SquarePoint at) {
    return a + (at.u * (b - a) + at.v * (c - a));
}

/// Ends of the faces laid end to end, each as long as twice its area.
std::vector<double> area_ends(Points vertices, Triangles faces);

}  // namespace gaussmap
