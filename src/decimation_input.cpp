#include "decimation_input.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "bounding_box.h"
#include "gaussmap/neighbors.h"

namespace gaussmap {
namespace {

std::vector<std::int32_t> usable_faces(Points vertices, Triangles faces, DecimationInput& in) {
    std::vector<std::int32_t> usable;
    for (std::size_t f = 0; f < faces.count; ++f) {
        const std::int32_t *abc = faces[f], a = abc[0], b = abc[1], c = abc[2];
        if (a == b || b == c || c == a)
            ++in.degenerate;
        else if (!finite(load(vertices[a])) || !finite(load(vertices[b])) || !finite(load(vertices[c])))
            ++in.non_finite;
        else
            usable.push_back(static_cast<std::int32_t>(f));
    }
    return usable;
}

/// Faces by the least of their vertices, which comes first, then by the others, then by their index.
void sort_faces(Triangles faces, const std::vector<std::int32_t>& rank, DecimationInput& in) {
    struct Key {
        std::int32_t second, third, face;
        std::int8_t rotation;
        bool operator<(const Key& other) const {
            return std::tie(second, third, face) < std::tie(other.second, other.third, other.face);
        }
    };
    const auto least_corner = [&](std::int32_t f) {
        const std::int32_t a = rank[faces[f][0]], b = rank[faces[f][1]], c = rank[faces[f][2]];
        return a < b && a < c ? 0 : b < c ? 1 : 2;
    };
    // A bucket for each least vertex, then the few faces in each.
    std::vector<std::size_t> begin(in.positions.size() + 1, 0);
    for (const std::int32_t f : in.faces) ++begin[static_cast<std::size_t>(rank[faces[f][least_corner(f)]]) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Key> keys(in.faces.size());
    std::vector<std::size_t> end(begin.begin(), begin.end() - 1);
    for (const std::int32_t f : in.faces) {
        const int k = least_corner(f);
        keys[end[static_cast<std::size_t>(rank[faces[f][k]])]++] = {
            rank[faces[f][(k + 1) % 3]], rank[faces[f][(k + 2) % 3]], f, static_cast<std::int8_t>(k)};
    }
    in.corners.reserve(3 * keys.size());
    in.rotation.reserve(keys.size());
    for (std::size_t v = 0; v < end.size(); ++v) {
        std::sort(&keys[0] + begin[v], &keys[0] + end[v]);
        for (std::size_t i = begin[v]; i < end[v]; ++i) {
            in.faces[i] = keys[i].face;
            in.rotation.push_back(keys[i].rotation);
            in.corners.insert(in.corners.end(), {static_cast<std::int32_t>(v), keys[i].second, keys[i].third});
        }
    }
}

}  // namespace

DecimationInput decimation_input(Points vertices, Triangles faces, const Execution& run) {
    DecimationInput in;
    in.faces = usable_faces(vertices, faces, in);
    if (in.faces.empty()) return in;
    std::vector<std::int32_t> rank(vertices.count, -1), used;
    for (const std::int32_t f : in.faces)
        for (int k = 0; k < 3; ++k) rank[faces[f][k]] = 0;
    std::vector<double> points;
    for (std::size_t v = 0; v < vertices.count; ++v) {
        if (rank[v] < 0) continue;
        used.push_back(static_cast<std::int32_t>(v));
        points.insert(points.end(), vertices[v], vertices[v] + 3);
    }
    std::vector<std::int32_t> order = spatial_order(points, {run.threads, {}});
    BoundingBox box;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::int32_t v = used[order[i]];
        box.include(load(vertices[v]));
        order[i] = v;
        rank[v] = static_cast<std::int32_t>(i);
    }
    // Halves first: a box as large as doubles reach has a centre, and a diagonal.
    in.centre = 0.5 * box.low + 0.5 * box.high;
    const Vec3 half = 0.5 * box.high - 0.5 * box.low;
    const double largest = std::max({half.x, half.y, half.z});
    in.diagonal = largest > 0 ? 2 * largest * length(1 / largest * half) : 1;
    for (const std::int32_t v : order) in.positions.push_back(1 / in.diagonal * (load(vertices[v]) - in.centre));
    sort_faces(faces, rank, in);
    return in;
}

}  // namespace gaussmap
