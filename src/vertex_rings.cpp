#include "vertex_rings.h"

#include <algorithm>
#include <utility>

#include "check.h"
#include "eigen3.h"
#include "shape_tensor.h"
#include "vec.h"

namespace gaussmap {
namespace {

/// Neighbours that are read at once, whether or not there are as many.
constexpr std::size_t at_once = 8;

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
/// lie on one line or two, and determine nothing; the rings do. Across a border it is shorter than along it: half discs
/// hold too few rows for a quartic.
class RingMetric {
  public:
    /// \param rings   differences from the vertex.
    /// \param border  whether a border is among them.
    RingMetric(const std::vector<Vec3>& rings, bool border) {
        Symmetric3 moments;
        Vec3 sum;
        for (const Vec3 d : rings) add_product(moments, 1, d, d), sum = sum + d;
        const Eigen3 axes = eigen(moments);
        // Across the surface as along the shorter of its axes.
        const double least = std::max(axes.values[1], 1e-6 * axes.values[2]);
        axis_ = axes.vectors[2];
        along_ = least > 0 ? least / axes.values[2] - 1 : 0;
        if (!border) return;

        inward_ = sum - dot(sum, axes.vectors[0]) * axes.vectors[0];
        inward_ = inward_ + along_ * dot(axis_, inward_) * axis_;
        double first = 0, second = 0;
        for (const Vec3 d : rings) first += dot(inward_, d), second += dot(inward_, d) * dot(inward_, d);
        if (!(second > 0)) return;
        // 0 where rings are the same on either side, 0.57 on straight borders of grids.
        const double one_sided = first * first / (second * static_cast<double>(rings.size()));
        deep_ = -std::min(1.2 * one_sided, 0.75) / first;
    }

    double operator()(Vec3 d) const {
        const double t = dot(axis_, d), in = dot(inward_, d);
        return squared(d) + along_ * t * t + deep_ * in * in;
    }

  private:
    Vec3 axis_, inward_;
    double along_, deep_ = 0;
};

}  // namespace

VertexRings::VertexRings(Points vertices, Triangles faces)
    : vertices_(vertices), offset_(vertices.count + 1), open_(vertices.count) {
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
        open_[v] =
            last - first < 2 * (end - neighbor_.begin() - static_cast<std::ptrdiff_t>(offset_[v])) || first == last;
    }
    offset_.back() = static_cast<std::size_t>(end - neighbor_.begin());
    neighbor_.resize(offset_.back() + at_once, 0);
    neighbor_.shrink_to_fit();
}

void VertexRings::Room::begin(std::size_t vertices, std::int32_t vertex) {
    for (std::size_t j = 0; j < met_count_; ++j) known_[static_cast<std::size_t>(met_[j])] = 0;
    known_.resize(vertices, 0);
    if (met_.empty()) met_.resize(1);
    met_[0] = vertex;
    met_count_ = 1;
    known_[static_cast<std::size_t>(vertex)] = 1;
}

/// Those that are not met yet. Without a branch on which they are, nor on how many there are if those are few, as no
/// processor could guess.
void VertexRings::Room::enter(const std::int32_t* around, std::size_t degree) {
    const std::size_t most = std::max(degree, at_once);
    if (met_.size() < met_count_ + most) met_.resize(2 * (met_count_ + most));
    std::int32_t* const met = met_.data();
    std::uint8_t* const known = known_.data();
    std::size_t count = met_count_;
    const auto take = [&](std::size_t j) {
        const std::int32_t vertex = around[j];
        const auto fresh = static_cast<std::uint8_t>((known[vertex] ^ 1U) & static_cast<unsigned>(j < degree));
        met[count] = vertex;
        known[vertex] |= fresh;
        count += fresh;
    };
    for (std::size_t j = 0; j < at_once; ++j) take(j);
    for (std::size_t j = at_once; j < degree; ++j) take(j);
    met_count_ = count;
}

/// Nearest first, ties by index, as far as the first `wanted` of all; by buckets, since squared distances on a surface
/// are spread evenly, and then by insertion, since hardly any is far from its place.
void VertexRings::Room::sort(std::size_t from, std::size_t wanted) {
    const auto nearer = [](const Met& a, const Met& b) {
        return a.squared < b.squared || (a.squared == b.squared && a.index < b.index);
    };
    constexpr std::size_t few = 16;
    constexpr double least = 1e-290;  // whose inverse is finite
    const std::size_t count = nearest_.size() - from;
    Met* const begin = nearest_.data() + from;
    Met* end = begin + count;
    double farthest = 0;
    for (const Met* met = begin; met != end; ++met) farthest = std::max(farthest, met->squared);
    if (count >= few && farthest >= least) {
        const auto bucket = [per = static_cast<double>(count - 1) / farthest](const Met& met) {
            return static_cast<std::size_t>(met.squared * per);
        };
        ends_.assign(count, 0);
        for (const Met* met = begin; met != end; ++met) ++ends_[bucket(*met)];
        std::uint32_t before = 0;
        for (std::uint32_t& e : ends_) before += std::exchange(e, before);
        unsorted_.assign(begin, end);
        for (const Met& met : unsorted_) begin[ends_[bucket(met)]++] = met;
        const auto enough =
            std::find_if(ends_.begin(), ends_.end() - 1, [&](std::uint32_t e) { return from + e >= wanted; });
        end = begin + *enough;
    }
    for (Met* met = begin; met != end; ++met) {
        const Met moved = *met;
        Met* to = met;
        for (; to != begin && nearer(moved, to[-1]); --to) *to = to[-1];
        *to = moved;
    }
}

/// Whole rings until there are enough; the sizes of the first and of the first two, the vertex included.
void VertexRings::meet(std::size_t vertex, std::size_t enough, std::size_t hub, Room& room,
                       std::size_t (&inner)[2]) const {
    room.begin(vertices_.count, static_cast<std::int32_t>(vertex));
    std::size_t rings = 0;
    for (std::size_t at = 0; at < room.met_count_ && room.met_count_ <= enough; ++rings) {
        for (const std::size_t end = room.met_count_; at < end; ++at) {
            const auto v = static_cast<std::size_t>(room.met_[at]);
            // A fan about a hub would put all of its rim into every search.
            if (v != vertex && degree(v) > hub) continue;
            room.enter(neighbor_.data() + offset_[v], degree(v));
        }
        for (std::size_t r = rings; r < 2; ++r) inner[r] = room.met_count_;
    }
}

void VertexRings::nearest(std::size_t vertex, int k, Room& room, std::int32_t* row) const {
    const auto wanted = static_cast<std::size_t>(k);
    std::size_t inner[2] = {};  // vertices met on the first ring, and on the first two
    meet(vertex, wanted + wanted / 4, 4 * wanted, room, inner);
    const Vec3 here = load(vertices_[vertex]);
    room.rings_.clear();
    bool border = false;
    for (std::size_t j = 1; j < inner[1]; ++j) {
        room.rings_.push_back(load(vertices_[room.met_[j]]) - here);
        border = border || open(static_cast<std::size_t>(room.met_[j]));
    }
    const RingMetric metric(room.rings_, border);
    room.nearest_.clear();
    std::size_t sorted = 0;
    for (std::size_t j = 0; j < room.met_count_; ++j) {
        const Vec3 d = load(vertices_[room.met_[j]]) - here;
        if (squared(d) > 0) room.nearest_.push_back({metric(d), room.met_[j]});
        if (j + 1 == inner[0] || j + 1 == inner[1]) room.sort(sorted, wanted), sorted = room.nearest_.size();
    }
    room.sort(sorted, wanted);
    const std::size_t found = std::min(wanted, room.nearest_.size());
    for (std::size_t j = 0; j < wanted; ++j) row[j] = j < found ? room.nearest_[j].index : -1;
}

}  // namespace gaussmap
