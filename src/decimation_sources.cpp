#include "decimation_sources.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "gaussmap/distance.h"
#include "parallel.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

/// From a corner on a seam towards the middle of its face, as a part of the way: little beside the faces of the input.
constexpr double side_step = 1e-3;

/// The point of the input's face f nearest to p, the corners as the input has them.
SurfacePoint on_face(const DecimationInput& in, std::int32_t f, Vec3 p) {
    const std::int32_t* v = &in.corners[3 * f];
    const TriangleHit hit = closest_on_triangle(p, in.positions[v[0]], in.positions[v[1]], in.positions[v[2]]);
    const double weights[] = {hit.u, hit.v, hit.w};
    SurfacePoint out{in.faces[f], {}};
    for (int k = 0; k < 3; ++k) out.weights[(k + in.rotation[f]) % 3] = weights[k];
    return out;
}

/// Faces numbered by the part of the surface that they are on, seams parting it.
std::vector<std::int32_t> charts_of(const RingMesh& fine) {
    std::vector<std::int32_t> chart(fine.tags.size());
    std::iota(chart.begin(), chart.end(), 0);
    const auto root = [&](std::int32_t f) {
        while (chart[f] != f) f = chart[f] = chart[chart[f]];
        return f;
    };
    for (std::size_t c = 0; c < fine.vertex.size(); ++c) {
        const auto corner = static_cast<std::int32_t>(c);
        if (fine.tagged(corner)) continue;
        const std::int32_t twin = fine.twin(corner);
        if (twin < 0) continue;
        const std::int32_t a = root(corner / 3), b = root(twin / 3);
        chart[std::max(a, b)] = std::min(a, b);
    }
    for (std::size_t f = 0; f < chart.size(); ++f) chart[f] = root(static_cast<std::int32_t>(f));
    return chart;
}

/// Indices grouped by a number each: sorted by it, stable.
std::vector<std::int32_t> sorted_by(const std::vector<std::int32_t>& key) {
    std::vector<std::int32_t> order(key.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) { return key[a] < key[b]; });
    return order;
}

}  // namespace

std::vector<SurfacePoint> joined_sources(const DecimationInput& in, const RingMesh& coarse,
                                         const std::vector<std::int32_t>& joined) {
    const std::size_t count = coarse.position.size();
    const auto apart = [&](std::size_t v) { return squared(in.positions[v] - coarse.position[joined[v]]); };
    std::vector<std::int32_t> nearest(count, -1);
    for (std::size_t v = 0; v < joined.size(); ++v) {
        if (joined[v] < 0) continue;
        std::int32_t& kept = nearest[joined[v]];
        if (kept < 0 || apart(v) < apart(static_cast<std::size_t>(kept))) kept = static_cast<std::int32_t>(v);
    }
    std::vector<double> least(count, std::numeric_limits<double>::infinity());
    std::vector<std::int32_t> face(count, -1);
    for (std::size_t c = 0; c < in.corners.size(); ++c) {
        const std::int32_t v = joined[in.corners[c]];
        if (v < 0 || nearest[v] != in.corners[c]) continue;
        const std::int32_t* abc = &in.corners[c - c % 3];
        const double distance =
            closest_on_triangle(coarse.position[v], in.positions[abc[0]], in.positions[abc[1]], in.positions[abc[2]])
                .squared;
        if (distance < least[v]) least[v] = distance, face[v] = static_cast<std::int32_t>(c / 3);
    }
    std::vector<SurfacePoint> out;
    for (std::size_t v = 0; v < count; ++v) out.push_back(on_face(in, face[v], coarse.position[v]));
    return out;
}

std::vector<SurfacePoint> vertex_sources(const DecimationInput& in, const FaceBoxes& fine, const RingMesh& coarse,
                                         const Execution& run) {
    std::vector<SurfacePoint> out(coarse.position.size());
    for_blocks(out.size(), 1 << 9, run, [&](std::size_t, std::size_t v, std::size_t end) {
        // The vertices are in an order of space too: the face of one is a good guess for the next.
        for (std::int32_t face = -1; v < end; ++v) {
            const Vec3 p = coarse.position[v];
            face = closest_face(fine, p, hit_of(fine, face, p)).face;
            out[v] = on_face(in, face, p);
        }
    });
    return out;
}

std::vector<SurfacePoint> corner_sources(const DecimationInput& in, const RingMesh& fine, const RingMesh& coarse,
                                         const Execution& run) {
    const std::vector<std::int32_t> chart = charts_of(fine);
    std::vector<std::int32_t> chart_of_coarse;
    for (const std::int32_t origin : coarse.origin) chart_of_coarse.push_back(chart[origin]);
    const std::vector<std::int32_t> fine_order = sorted_by(chart), coarse_order = sorted_by(chart_of_coarse);
    std::vector<SurfacePoint> out(coarse.vertex.size());
    std::vector<std::int32_t> local(in.positions.size(), -1), corners;
    std::vector<double> points, queries;
    std::size_t at = 0;
    for (std::size_t begin = 0, end = 0; begin < coarse_order.size(); begin = end) {
        const std::int32_t wanted = chart_of_coarse[coarse_order[begin]];
        while (end < coarse_order.size() && chart_of_coarse[coarse_order[end]] == wanted) ++end;
        while (chart[fine_order[at]] != wanted) ++at;
        const std::size_t first = at;
        points.clear(), corners.clear(), queries.clear();
        std::vector<std::int32_t> used;
        for (; at < fine_order.size() && chart[fine_order[at]] == wanted; ++at)
            for (int k = 0; k < 3; ++k) {
                const std::int32_t v = in.corners[3 * fine_order[at] + k];
                if (local[v] < 0) {
                    local[v] = static_cast<std::int32_t>(used.size());
                    used.push_back(v);
                    points.insert(points.end(), {in.positions[v].x, in.positions[v].y, in.positions[v].z});
                }
                corners.push_back(local[v]);
            }
        for (const std::int32_t v : used) local[v] = -1;
        const auto position = [&](std::size_t i, int k) {
            return coarse.position[coarse.vertex[3 * coarse_order[i] + k]];
        };
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 centre = (1.0 / 3) * (position(i, 0) + position(i, 1) + position(i, 2));
            for (int k = 0; k < 3; ++k) {
                Vec3 p = position(i, k);
                // A chart may touch itself along a seam: a step into the face tells the sides apart.
                if (coarse.kind[coarse.vertex[3 * coarse_order[i] + k]] != VertexKind::free)
                    p = p + side_step * (centre - p);
                queries.insert(queries.end(), {p.x, p.y, p.z});
            }
        }
        const std::vector<std::int32_t> element = ClosestIndex(points, corners, run).closest(queries, run).element;
        for (std::size_t i = begin; i < end; ++i)
            for (int k = 0; k < 3; ++k)
                out[3 * coarse_order[i] + k] =
                    on_face(in, fine_order[first + element[3 * (i - begin) + k]], position(i, k));
    }
    return out;
}

}  // namespace gaussmap
