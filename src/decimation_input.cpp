#include "decimation_input.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>

#include "bounding_box.h"
#include "ordered_cloud.h"

namespace gaussmap {
namespace {

/// What is known of a vertex, in bits.
constexpr std::uint8_t is_finite = 1, is_used = 2;

/// Finds the usable faces, and marks their vertices.
std::vector<std::int32_t> usable_faces(Triangles faces, std::vector<std::uint8_t>& known, DecimationInput& in) {
    std::vector<std::int32_t> usable;
    usable.reserve(faces.count);
    for (std::size_t f = 0; f < faces.count; ++f) {
        const std::int32_t *abc = faces[f], a = abc[0], b = abc[1], c = abc[2];
        if (a == b || b == c || c == a) {
            ++in.degenerate;
        } else if ((known[a] & known[b] & known[c] & is_finite) == 0) {
            ++in.non_finite;
        } else {
            usable.push_back(static_cast<std::int32_t>(f));
            known[a] |= is_used, known[b] |= is_used, known[c] |= is_used;
        }
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
    const std::size_t count = in.faces.size();
    in.corners.resize(3 * count);
    in.rotation.resize(count);
    // A bucket for each least vertex, then the few faces in each.
    std::vector<std::int32_t> end(in.positions.size() + 1, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t* abc = faces[in.faces[i]];
        const std::array<std::int32_t, 3> ranks{rank[abc[0]], rank[abc[1]], rank[abc[2]]};
        const int k = static_cast<int>(std::min_element(ranks.begin(), ranks.end()) - ranks.begin());
        for (int j = 0; j < 3; ++j) in.corners[3 * i + j] = ranks[(k + j) % 3];
        in.rotation[i] = static_cast<std::int8_t>(k);
        ++end[ranks[k] + 1];
    }
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<Key> keys(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t* corner = &in.corners[3 * i];
        keys[end[corner[0]]++] = {corner[1], corner[2], in.faces[i], in.rotation[i]};
    }
    std::int32_t i = 0;
    for (std::size_t v = 0; v + 1 < end.size(); ++v) {
        if (end[v] - i > 1) std::sort(&keys[i], &keys[0] + end[v]);
        for (; i < end[v]; ++i) {
            in.faces[i] = keys[i].face;
            in.rotation[i] = keys[i].rotation;
            in.corners[3 * i] = static_cast<std::int32_t>(v);
            in.corners[3 * i + 1] = keys[i].second, in.corners[3 * i + 2] = keys[i].third;
        }
    }
}

}  // namespace

DecimationInput decimation_input(Points vertices, Triangles faces, const Execution& run) {
    DecimationInput in;
    std::vector<std::uint8_t> known(vertices.count);
    for (std::size_t v = 0; v < known.size(); ++v) known[v] = finite(load(vertices[v])) ? is_finite : 0;
    in.faces = usable_faces(faces, known, in);
    if (in.faces.empty()) return in;
    std::vector<std::int32_t> used;
    used.reserve(vertices.count);
    BoundingBox box;
    for (std::size_t v = 0; v < known.size(); ++v) {
        if ((known[v] & is_used) == 0) continue;
        used.push_back(static_cast<std::int32_t>(v));
        box.include(load(vertices[v]));
    }
    // Halves first: a box as large as doubles reach has a centre, and a diagonal.
    in.centre = 0.5 * box.low + 0.5 * box.high;
    const Vec3 half = 0.5 * box.high - 0.5 * box.low;
    const double largest = std::max({half.x, half.y, half.z});
    in.diagonal = largest > 0 ? 2 * largest * length(1 / largest * half) : 1;

    const std::vector<std::int32_t> order = spatial_order_of(vertices, used, {run.threads, {}});
    std::vector<std::int32_t> rank(vertices.count);
    in.positions.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::int32_t v = order[i];
        in.positions[i] = 1 / in.diagonal * (load(vertices[v]) - in.centre);
        rank[v] = static_cast<std::int32_t>(i);
    }
    sort_faces(faces, rank, in);
    return in;
}

}  // namespace gaussmap
