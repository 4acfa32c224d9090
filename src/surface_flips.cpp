// Sides flipped where the samples of their two faces come nearer.
#include <algorithm>

#include "surface_fit.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

/// 2 area / Σ edge²: 0.289 equilateral, 0 degenerate.
double shape_of(Vec3 a, Vec3 b, Vec3 c) {
    const double l = squared(b - a) + squared(c - b) + squared(a - c);
    return l > 0 ? length(cross(b - a, c - a)) / l : 0;
}

bool joined(const RingMesh& mesh, std::int32_t a, std::int32_t b) {
    bool found = false;
    mesh.for_corners(a, [&](std::int32_t c) {
        found |= mesh.vertex[RingMesh::after(c)] == b || mesh.vertex[RingMesh::before(c)] == b;
    });
    return found;
}

}  // namespace

std::size_t flip_sides(RingMesh& mesh, FitSamples& samples, const FitNorm& norm) {
    const FaceSamples rows = by_face(samples, mesh.tags.size());
    std::vector<bool> done(mesh.tags.size(), false);
    std::size_t flips = 0;
    for (std::size_t i = 0; i < mesh.vertex.size(); ++i) {
        const auto corner = static_cast<std::int32_t>(i);
        if (mesh.vertex[i] < 0 || mesh.tagged(corner) || done[i / 3]) continue;
        const std::int32_t twin = mesh.twin(corner);
        if (twin < corner || done[twin / 3]) continue;
        const std::int32_t f = corner / 3, g = twin / 3;
        const std::int32_t a = mesh.vertex[corner], d = mesh.vertex[twin];
        const std::int32_t b = mesh.vertex[RingMesh::after(corner)], c = mesh.vertex[RingMesh::before(corner)];
        if (a == d) continue;
        const Vec3 pa = mesh.position[a], pb = mesh.position[b], pc = mesh.position[c], pd = mesh.position[d];
        // Neither new face may turn against either old one.
        if (turns_over(pa, pb, pc, pa, pb, pd) || turns_over(pa, pb, pc, pd, pc, pa) ||
            turns_over(pd, pc, pb, pa, pb, pd) || turns_over(pd, pc, pb, pd, pc, pa))
            continue;
        double before = 0, after = 0;
        for (const std::int32_t face : {f, g})
            rows.for_each(face, [&](std::int32_t k) {
                const Vec3 p = samples.point[k];
                before += samples.area[k] * norm.cost(samples.squared_distance[k]);
                after += samples.area[k] * norm.cost(std::min(closest_on_triangle(p, pa, pb, pd).squared,
                                                              closest_on_triangle(p, pd, pc, pa).squared));
            });
        const double shape = std::min(shape_of(pa, pb, pc), shape_of(pd, pc, pb)),
                     new_shape = std::min(shape_of(pa, pb, pd), shape_of(pd, pc, pa));
        if (!(after < 0.98 * before || (after <= 1.01 * before && new_shape > 1.5 * shape)) || joined(mesh, a, d))
            continue;
        mesh.flip(corner, twin);
        done[f] = done[g] = true;
        for (const std::int32_t face : {f, g})
            rows.for_each(face, [&](std::int32_t k) { assign_around(mesh, samples, static_cast<std::size_t>(k), a); });
        ++flips;
    }
    return flips;
}

}  // namespace gaussmap
