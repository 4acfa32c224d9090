#include "collapse_passes.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "collapse_lanes.h"
#include "local_quadric.h"
#include "parallel.h"
#include "scatter.h"

namespace gaussmap {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr std::size_t grain = 1 << 13;

class Passes {
  public:
    Passes(RingMesh& mesh, std::vector<float> weight, const CollapseOptions& options)
        : mesh_(mesh),
          options_(options),
          weight_(std::move(weight)),
          shape_(options.cost == CollapseCost::length ? 0 : mesh.first.size()),
          rest_(options.cost == CollapseCost::inherited ? mesh.first.size() : 0),
          key_(mesh.first.size()),
          partner_(mesh.first.size(), -1),
          state_(mesh.first.size(), stale),
          parent_(mesh.first.size()) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    std::vector<std::int32_t> run() {
        const std::size_t start = mesh_.face_count(), target = options_.faces;
        if (start > target && !shape_.empty()) find_first_shapes();
        double boost = 1;  // where what is cheap is not valid
        while (mesh_.face_count() > target) {
            const std::size_t faces = mesh_.face_count();
            // Memory is walked in order: worth a copy as soon as half of it is gone.
            if (2 * faces < mesh_.tags.size()) close_gaps();
            if (faces < start && options_.cost == CollapseCost::present) find_shapes();
            find_keys();
            if (keys_.empty()) break;
            const auto wanted = static_cast<std::size_t>(boost * static_cast<double>(share(faces)));
            sweep(limit(wanted));
            const std::size_t gone = faces - mesh_.face_count();
            if (gone == 0 && wanted >= keys_.size()) break;
            boost = 4 * gone < wanted ? std::min(2 * boost, 1e9) : 1;
            if (options_.run.progress && !options_.run.progress(static_cast<double>(start - mesh_.face_count()) /
                                                                static_cast<double>(start - target)))
                throw Cancelled();
        }
        close_gaps();
        return std::move(joined_);
    }

  private:
    enum State : std::uint8_t {
        fresh,
        stale,    ///< something around has changed since the key was made
        checked,  ///< the partner is the best of those with which the collapse was valid
        joined    ///< in this pass
    };
    /// xᵀ A x − 2 g·x + c, x from the middle of an edge.
    struct EdgeQuadric {
        Symmetric a;
        Vec3 g;
        double c;
        double at(Vec3 x) const { return std::max(0.0, dot(x, a.times(x) - 2 * g) + c); }
    };

    /// Vertices to offer in a pass: most of them far from the target, few near to it, never more than there are to go.
    /// About half of them can be taken, the others having met one that was.
    std::size_t share(std::size_t faces) const {
        const double vertices = 0.5 * static_cast<double>(faces);
        const std::size_t excess = (faces - options_.faces + 1) / 2;
        const double part = static_cast<double>(excess) / vertices;
        return std::clamp(static_cast<std::size_t>(options_.share * (1 + 7 * part * part) * vertices), std::size_t{1},
                          excess);
    }

    /// The key of which no more than `wanted` are below.
    float limit(std::size_t wanted) {
        const auto rank = static_cast<std::ptrdiff_t>(std::min(keys_.size(), wanted) - 1);
        std::nth_element(keys_.begin(), keys_.begin() + rank, keys_.end());
        return keys_[rank];
    }

    /// Call body(v, room) for the vertices that something has changed around.
    template <class Body>
    void for_stale(Body&& body) {
        for_blocks(state_.size(), grain, {options_.run.threads, {}},
                   [&](std::size_t, std::size_t begin, std::size_t end) {
                       RingMesh::Sectors room;
                       for (std::size_t v = begin; v < end; ++v)
                           if (state_[v] == stale || state_[v] == joined) body(static_cast<std::int32_t>(v), room);
                   });
    }

    /// Of all vertices: each face is looked at once.
    void find_first_shapes() {
        const std::size_t n = shape_.size();
        const Triangles faces(mesh_.vertex.data(), mesh_.tags.size());
        const Execution run{options_.run.threads, {}};
        scatter_batches<6>(faces, n, chunk_faces(faces, n, run), run, &shape_[0].xx,
                           [&](std::size_t begin, std::size_t end, auto* corners) {
                               lanes_.face_planes(mesh_.position.data(), faces[begin], end - begin, corners[0][0]);
                           });
        for_stale([&](std::int32_t v, auto& sectors) {
            if (mesh_.kind[v] != VertexKind::free) mesh_.gather(v, sectors);
            finish_shape(v, sectors);
        });
    }

    /// Of those that something has changed around.
    void find_shapes() {
        for_stale([&](std::int32_t v, auto& sectors) {
            mesh_.gather(v, sectors);
            shape_[v] = lanes_.planes(mesh_.position.data(), sectors.begin(), sectors.size(), mesh_.position[v]);
            finish_shape(v, sectors);
        });
    }

    void finish_shape(std::int32_t v, const RingMesh::Sectors& sectors) {
        if (mesh_.kind[v] != VertexKind::free) add_sides(shape_[v], v, sectors);
        shape_[v] *= weight_[v];
    }

    void find_keys() {
        for_stale([&](std::int32_t v, auto&) { choose(v); });
        keys_.clear();
        std::copy_if(key_.begin(), key_.end(), std::back_inserter(keys_), [](float key) { return key < never; });
    }

    /// Planes on the tagged sides that end in v, upright on their faces. Weight |side|², as for the area of the surface
    /// that it ends.
    void add_sides(Symmetric& sum, std::int32_t v, const RingMesh::Sectors& sectors) const {
        const Vec3 p = mesh_.position[v];
        for (const RingMesh::Sector& sector : sectors) {
            const Vec3 s = mesh_.position[sector.from] - p, t = mesh_.position[sector.to] - p, normal = cross(s, t);
            const auto add = [&](Vec3 side) {
                const Vec3 upright = cross(normal, side);
                const double l = squared(upright);
                if (l > 0) sum.add_normal(upright, options_.border_weight * squared(side) / l);
            };
            if (mesh_.tagged(RingMesh::before(sector.corner))) add(s);
            if (mesh_.tagged(RingMesh::after(sector.corner))) add(t);
        }
    }

    /// \param half  of the edge, from a to its middle.
    EdgeQuadric sum_of(std::int32_t a, std::int32_t b, Vec3 half) const {
        const Vec3 of_a = shape_[a].times(half), of_b = shape_[b].times(half);
        EdgeQuadric sum{shape_[a] + shape_[b], of_b - of_a, dot(half, of_a + of_b)};
        if (!rest_.empty()) {
            sum.g = sum.g + rest_[a].b + rest_[b].b;
            sum.c += rest_[a].c + rest_[b].c - 2 * dot(rest_[a].b - rest_[b].b, half);
        }
        return sum;
    }

    double cost(std::int32_t a, std::int32_t b) const {
        const VertexKind ka = mesh_.kind[a], kb = mesh_.kind[b];
        double cost = never;
        if (ka == VertexKind::corner && kb == VertexKind::corner) return cost;
        const Vec3 half = 0.5 * (mesh_.position[b] - mesh_.position[a]);
        if (options_.cost == CollapseCost::length) return (weight_[a] + weight_[b]) * length(half);
        if (ka == kb) {
            lanes_.costs(quadrics(), a, &b, 1, &cost);
            return cost;
        }
        const EdgeQuadric sum = sum_of(a, b, half);
        return 4 * flat_cost * sum.a.trace() * squared(half) + sum.at(ka > kb ? -half : half);
    }
    VertexQuadrics quadrics() const {
        return {mesh_.position.data(), shape_.data(), rest_.empty() ? nullptr : rest_.data()};
    }

    /// Where a and b join.
    Vec3 place(std::int32_t a, std::int32_t b) const {
        const VertexKind ka = mesh_.kind[a], kb = mesh_.kind[b];
        const Vec3 pa = mesh_.position[a], pb = mesh_.position[b], middle = 0.5 * (pa + pb);
        if (ka != kb) return ka > kb ? pa : pb;
        if (options_.cost == CollapseCost::length) return middle;
        const EdgeQuadric sum = sum_of(a, b, 0.5 * (pb - pa));
        const double held = collapse_pull * sum.a.trace();
        const Vec3 p = held > 0 ? middle + HeldInverse(sum.a, held).times(sum.g) : middle;
        return finite(p) ? p : middle;
    }

    /// The cheapest partner of a higher number, ties by index: each edge is looked at from one of its ends.
    void choose(std::int32_t v) {
        double least = never;
        std::int32_t partner = -1;
        const auto take = [&](std::int32_t w, double at) {
            if (at < least || (at == least && w < partner)) least = at, partner = w;
        };
        std::array<std::int32_t, 16> alike;  // of the kind of v: several at a time
        std::array<double, 16> costs;
        std::size_t count = 0;
        const auto take_alike = [&] {
            lanes_.costs(quadrics(), v, alike.data(), count, costs.data());
            for (std::size_t i = 0; i < count; ++i) take(alike[i], costs[i]);
            count = 0;
        };
        const VertexKind kind = mesh_.kind[v];
        const bool one_by_one = options_.cost == CollapseCost::length || kind == VertexKind::corner;
        const auto offer = [&](std::int32_t w) {
            const bool is_alike = !one_by_one && mesh_.kind[w] == kind;
            if (!is_alike && w > v) take(w, cost(v, w));
            alike[count] = w;
            count += is_alike & (w > v);  // no branch: half of them are
            if (count == alike.size()) take_alike();
        };
        mesh_.for_corners(v, [&](std::int32_t c) {
            // On a closed fan every neighbour comes after v in one face.
            offer(mesh_.vertex[RingMesh::after(c)]);
            if (kind != VertexKind::free) offer(mesh_.vertex[RingMesh::before(c)]);
        });
        if (count > 0) take_alike();
        key_[v] = static_cast<float>(least), partner_[v] = partner;
        state_[v] = fresh;
    }

    /// Collapse, in the order of space, what costs no more than the limit. No vertex joins twice.
    void sweep(float limit) {
        for (std::size_t i = 0; i < key_.size(); ++i) {
            const auto v = static_cast<std::int32_t>(i);
            const std::int32_t w = partner_[v];
            if (!(key_[v] <= limit) || w < 0 || state_[v] == joined || state_[w] == joined || mesh_.first[w] < 0)
                continue;
            const Vec3 p = place(v, w);
            if (valid(v, w, p)) {
                join(v, w, p);
                if (mesh_.face_count() <= options_.faces) return;
            } else if (state_[v] != stale) {
                choose_valid(v);
            }
        }
    }

    bool valid(std::int32_t a, std::int32_t b, Vec3 p) {
        mesh_.look(a, b, edge_);
        return mesh_.refusal(edge_, options_.allow_topology) == Refusal::none && !mesh_.folds(edge_, p);
    }

    /// The cheapest partner with which the collapse is valid.
    void choose_valid(std::int32_t v) {
        offers_.clear();
        mesh_.for_neighbors(v, [&](std::int32_t w) {
            if (w > v) offers_.push_back({cost(v, w), w});
        });
        std::sort(offers_.begin(), offers_.end());
        const auto found = std::find_if(offers_.begin(), offers_.end(), [&](const std::pair<double, std::int32_t>& at) {
            return at.first < never && valid(v, at.second, place(v, at.second));
        });
        const bool any = found != offers_.end();
        key_[v] = static_cast<float>(any ? found->first : never), partner_[v] = any ? found->second : -1;
        state_[v] = checked;
    }

    /// b, of the higher number, joins a, as was found valid.
    void join(std::int32_t a, std::int32_t b, Vec3 p) {
        const double ta = shape_.empty() ? 1 : shape_[a].trace(), tb = shape_.empty() ? 1 : shape_[b].trace();
        if (ta + tb > 0) weight_[a] = static_cast<float>((ta * weight_[a] + tb * weight_[b]) / (ta + tb));
        if (!rest_.empty()) {
            const Vec3 pa = mesh_.position[a], pb = mesh_.position[b], x = p - 0.5 * (pa + pb);
            const EdgeQuadric sum = sum_of(a, b, 0.5 * (pb - pa));
            rest_[a] = {sum.g - sum.a.times(x), sum.at(x)};
        }
        if (!shape_.empty()) shape_[a] += shape_[b];
        mesh_.collapse(edge_, p);
        parent_[b] = a;
        key_[b] = static_cast<float>(never), state_[b] = fresh;
        mesh_.for_corners(a, [&](std::int32_t c) {
            for (const std::int32_t w : {mesh_.vertex[RingMesh::after(c)], mesh_.vertex[RingMesh::before(c)]})
                if (state_[w] != joined && changes(w, a, b)) state_[w] = stale;
        });
        state_[a] = joined;
    }

    /// Whether the key of a neighbour may be another now that b joined a. Where shapes stay, edges to lower numbers are
    /// not its own.
    bool changes(std::int32_t w, std::int32_t a, std::int32_t b) const {
        return options_.cost == CollapseCost::present || w < a || state_[w] == checked || partner_[w] == b;
    }

    void close_gaps() {
        // Vertices joined those of lower numbers, which are their own parents by now.
        for (std::int32_t& v : parent_) v = parent_[v];
        const std::vector<std::int32_t> renamed = mesh_.close_gaps();
        for (std::int32_t& v : parent_) v = renamed[v];
        if (joined_.empty())
            joined_ = parent_;
        else
            for (std::int32_t& v : joined_) v = v < 0 ? v : parent_[v];
        const auto close = [&](auto& values) {
            if (values.empty()) return;
            for (std::size_t v = 0; v < renamed.size(); ++v)
                if (renamed[v] >= 0) values[renamed[v]] = values[v];
            values.resize(mesh_.first.size());
        };
        close(weight_), close(shape_), close(rest_), close(key_), close(partner_), close(state_);
        for (std::int32_t& w : partner_) w = w < 0 ? w : renamed[w];
        parent_.resize(mesh_.first.size());
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    RingMesh& mesh_;
    const CollapseOptions& options_;
    const CollapseLanes& lanes_ = collapse_lanes();
    std::vector<float> weight_;
    std::vector<Symmetric> shape_;   ///< quadrics about their vertices; none where costs are lengths
    std::vector<QuadricRest> rest_;  ///< where quadrics are inherited
    std::vector<float> key_;         ///< what joining the partner costs
    std::vector<std::int32_t> partner_;
    std::vector<State> state_;
    std::vector<std::int32_t> parent_;  ///< the vertex that each joined since gaps were last closed
    std::vector<std::int32_t> joined_;  ///< the vertex, as numbered then, that each of the first ones had joined
    std::vector<float> keys_;           ///< room for those that are finite
    std::vector<std::pair<double, std::int32_t>> offers_;
    RingMesh::Edge edge_;  ///< last looked at
};

}  // namespace

std::vector<std::int32_t> collapse_in_passes(RingMesh& mesh, std::vector<float> weight,
                                             const CollapseOptions& options) {
    return Passes(mesh, std::move(weight), options).run();
}

}  // namespace gaussmap
