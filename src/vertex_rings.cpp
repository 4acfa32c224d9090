#include "vertex_rings.h"

#include <algorithm>

#include "check.h"
#include "eigen3.h"
#include "shape_tensor.h"
#include "vec.h"

namespace gaussmap {
namespace {

/// Call body(from, to) for both ways along every edge of every usable face.
template <class Body>
void for_edges(Points vertices, Triangles faces, Body&& body) {
    for (std::size_t f = 0; f < faces.count; ++f) {
        const std::int32_t a = faces[f][0], b = faces[f][1], c = faces[f][2];
        if (a == b || b == c || c == a) continue;
        if (!finite(load(vertices[a])) || !finite(load(vertices[b])) || !finite(load(vertices[c]))) continue;
        body(a, b), body(b, a), body(b, c), body(c, b), body(c, a), body(a, c);
    }
}

/// The squared length in which the rings about a vertex are round. On grids of unlike spacings, the nearest in space
/// lie on one line or two, and determine nothing; the rings do.
class RingMetric {
  public:
    /// \param moments  sum of d dᵀ over the rings.
    explicit RingMetric(const Symmetric3& moments) {
        const Eigen3 axes = eigen(moments);
        // Across the surface as along the shorter of its axes.
        const double least = std::max(axes.values[1], 1e-6 * axes.values[2]);
        axis_ = axes.vectors[2];
        along_ = least > 0 ? least / axes.values[2] - 1 : 0;
    }

    double operator()(Vec3 d) const {
        const double t = dot(axis_, d);
        return squared(d) + along_ * t * t;
    }

  private:
    Vec3 axis_;
    double along_;
};

}  // namespace

VertexRings::VertexRings(Points vertices, Triangles faces) : vertices_(vertices), offset_(vertices.count + 1) {
    check_faces(faces, vertices.count);
    for_edges(vertices, faces, [&](std::int32_t from, std::int32_t) { ++offset_[static_cast<std::size_t>(from)]; });
    std::size_t sum = 0;
    for (std::size_t& offset : offset_) sum += offset, offset = sum;
    neighbor_.resize(sum);
    // Filled from the ends, after which every offset is where its vertex's neighbours begin.
    for_edges(vertices, faces,
              [&](std::int32_t from, std::int32_t to) { neighbor_[--offset_[static_cast<std::size_t>(from)]] = to; });
    // An edge of two faces was met twice.
    auto end = neighbor_.begin();
    for (std::size_t v = 0; v < vertices.count; ++v) {
        const auto first = neighbor_.begin() + static_cast<std::ptrdiff_t>(offset_[v]),
                   last = neighbor_.begin() + static_cast<std::ptrdiff_t>(offset_[v + 1]);
        offset_[v] = static_cast<std::size_t>(end - neighbor_.begin());
        std::sort(first, last);
        end = std::unique_copy(first, last, end);
    }
    offset_.back() = static_cast<std::size_t>(end - neighbor_.begin());
    neighbor_.resize(offset_.back());
    neighbor_.shrink_to_fit();
}

void VertexRings::Room::begin(std::size_t slots) {
    met_.clear();
    if (slots_.size() < slots || ++search_ == 0) {
        std::size_t size = 64;
        while (size < slots) size *= 2;
        slots_.assign(std::max(size, slots_.size()), 0);
        search_ = 1;
    }
}

bool VertexRings::Room::enter(std::int32_t vertex) {
    const auto bits = static_cast<std::uint32_t>(vertex);
    const std::uint64_t entry = std::uint64_t{search_} << 32 | bits;
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = (bits * std::uint64_t{0x9e3779b97f4a7c15u} >> 32) & mask;
    for (; slots_[slot] >> 32 == search_; slot = (slot + 1) & mask)
        if (slots_[slot] == entry) return false;
    slots_[slot] = entry;
    met_.push_back(vertex);
    if (2 * met_.size() > slots_.size()) {
        const std::vector<std::int32_t> again = std::move(met_);
        begin(2 * slots_.size());
        for (const std::int32_t v : again) enter(v);
    }
    return true;
}

void VertexRings::nearest(std::size_t vertex, int k, Room& room, std::int32_t* row) const {
    const auto wanted = static_cast<std::size_t>(k), enough = wanted + wanted / 2, hub = 4 * wanted;
    room.begin(8 * wanted);
    room.enter(static_cast<std::int32_t>(vertex));
    std::size_t inner = 0, rings = 0;  // vertices on the two first rings
    for (std::size_t ring = 0; ring < room.met_.size() && room.met_.size() <= enough;) {
        for (const std::size_t end = room.met_.size(); ring < end; ++ring) {
            const auto v = static_cast<std::size_t>(room.met_[ring]);
            // A fan about a hub would put all of its rim into every search.
            if (v != vertex && degree(v) > hub) continue;
            for (std::size_t j = offset_[v]; j < offset_[v + 1]; ++j) room.enter(neighbor_[j]);
        }
        if (++rings <= 2) inner = room.met_.size();
    }
    const Vec3 here = load(vertices_[vertex]);
    Symmetric3 moments;
    for (std::size_t j = 0; j < inner; ++j) {
        const Vec3 d = load(vertices_[room.met_[j]]) - here;
        add_product(moments, 1, d, d);
    }
    const RingMetric metric(moments);
    room.nearest_.clear();
    for (const std::int32_t v : room.met_) {
        const Vec3 d = load(vertices_[v]) - here;
        if (squared(d) > 0) room.nearest_.push_back({metric(d), v});
    }
    const auto nearer = [](const Room::Met& a, const Room::Met& b) {
        return a.squared < b.squared || (a.squared == b.squared && a.index < b.index);
    };
    const std::size_t found = std::min(wanted, room.nearest_.size());
    const auto last = room.nearest_.begin() + static_cast<std::ptrdiff_t>(found);
    if (last != room.nearest_.end()) std::nth_element(room.nearest_.begin(), last, room.nearest_.end(), nearer);
    std::sort(room.nearest_.begin(), last, nearer);
    for (std::size_t j = 0; j < wanted; ++j) row[j] = j < found ? room.nearest_[j].index : -1;
}

}  // namespace gaussmap
