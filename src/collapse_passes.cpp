#include "collapse_passes.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "local_quadric.h"
#include "parallel.h"

namespace gaussmap {
namespace {

/// How firmly the best position is held to the middle of the edge, where the quadric is flat.
constexpr double pull = 1e-5;
/// What an edge of length l costs on a plane, as a squared distance over l²: short edges go first there.
constexpr double flat_cost = 1e-9;
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
        if (start > target) find_shapes();
        double boost = 1;  // where what is cheap is not valid
        while (mesh_.face_count() > target) {
            const std::size_t faces = mesh_.face_count();
            // Memory is walked in order: worth a copy as soon as a third of it is gone.
            if (3 * faces < 2 * mesh_.tags.size()) close_gaps();
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
    /// What is left of a quadric beside its shape: − 2 b·x + c, x from the vertex.
    struct Rest {
        Vec3 b;
        double c = 0;
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

    template <class Body>
    void for_stale(Body&& body) {
        for_blocks(state_.size(), grain, {options_.run.threads, {}},
                   [&](std::size_t, std::size_t begin, std::size_t end) {
                       for (std::size_t v = begin; v < end; ++v)
                           if (state_[v] == stale || state_[v] == joined) body(static_cast<std::int32_t>(v));
                   });
    }

    void find_shapes() {
        if (!shape_.empty()) for_stale([&](std::int32_t v) { shape_[v] = shape_of(v); });
    }

    void find_keys() {
        if (options_.cost == CollapseCost::present) find_shapes();
        for_stale([&](std::int32_t v) { choose(v); });
        keys_.clear();
        std::copy_if(key_.begin(), key_.end(), std::back_inserter(keys_), [](float key) { return key < never; });
    }

    /// Planes of the faces around v, and planes on the tagged sides that end in it, upright on their faces.
    Symmetric shape_of(std::int32_t v) const {
        Symmetric sum;
        const Vec3 p = mesh_.position[v];
        mesh_.for_corners(v, [&](std::int32_t c) {
            const std::int32_t n = RingMesh::after(c), q = RingMesh::before(c);
            const Vec3 s = mesh_.position[mesh_.vertex[n]] - p, t = mesh_.position[mesh_.vertex[q]] - p;
            const Vec3 normal = cross(s, t);
            const double twice_area = length(normal);
            if (twice_area > 0) sum.add_normal(normal, 0.5 / twice_area);
            if (mesh_.kind[v] == VertexKind::free) return;
            if (mesh_.tagged(q)) add_side(sum, s, normal);
            if (mesh_.tagged(n)) add_side(sum, t, normal);
        });
        sum *= weight_[v];
        return sum;
    }

    /// A side of a face of that normal: weight |side|², as for the area of the surface that it ends.
    void add_side(Symmetric& sum, Vec3 side, Vec3 normal) const {
        const Vec3 upright = cross(normal, side);
        const double l = squared(upright);
        if (l > 0) sum.add_normal(upright, options_.border_weight * squared(side) / l);
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
        if (ka == VertexKind::corner && kb == VertexKind::corner) return never;
        const Vec3 half = 0.5 * (mesh_.position[b] - mesh_.position[a]);
        if (options_.cost == CollapseCost::length) return (weight_[a] + weight_[b]) * length(half);
        const EdgeQuadric sum = sum_of(a, b, half);
        const double flat = 4 * flat_cost * sum.a.trace() * squared(half), held = pull * sum.a.trace();
        if (ka != kb) return flat + sum.at(ka > kb ? -half : half);
        if (!(held > 0)) return flat;
        return flat + std::max(0.0, sum.c - HeldInverse(sum.a, held).energy(sum.g));
    }

    /// Where a and b join.
    Vec3 place(std::int32_t a, std::int32_t b) const {
        const VertexKind ka = mesh_.kind[a], kb = mesh_.kind[b];
        const Vec3 pa = mesh_.position[a], pb = mesh_.position[b], middle = 0.5 * (pa + pb);
        if (ka != kb) return ka > kb ? pa : pb;
        if (options_.cost == CollapseCost::length) return middle;
        const EdgeQuadric sum = sum_of(a, b, 0.5 * (pb - pa));
        const double held = pull * sum.a.trace();
        const Vec3 p = held > 0 ? middle + HeldInverse(sum.a, held).times(sum.g) : middle;
        return finite(p) ? p : middle;
    }

    /// The cheapest partner of a higher number, ties by index: each edge is looked at from one of its ends.
    void choose(std::int32_t v) {
        double least = never;
        std::int32_t partner = -1;
        const auto offer = [&](std::int32_t w) {
            if (w < v) return;
            const double at = cost(v, w);
            if (at < least || (at == least && w < partner)) least = at, partner = w;
        };
        mesh_.for_corners(v, [&](std::int32_t c) {
            // On a closed fan every neighbour comes after v in one face.
            offer(mesh_.vertex[RingMesh::after(c)]);
            if (mesh_.kind[v] != VertexKind::free) offer(mesh_.vertex[RingMesh::before(c)]);
        });
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
        return mesh_.refusal(a, b, options_.allow_topology) == Refusal::none && !mesh_.folds(a, b, p);
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

    /// b, of the higher number, joins a.
    void join(std::int32_t a, std::int32_t b, Vec3 p) {
        const double ta = shape_.empty() ? 1 : shape_[a].trace(), tb = shape_.empty() ? 1 : shape_[b].trace();
        if (ta + tb > 0) weight_[a] = static_cast<float>((ta * weight_[a] + tb * weight_[b]) / (ta + tb));
        if (!rest_.empty()) {
            const Vec3 pa = mesh_.position[a], pb = mesh_.position[b], x = p - 0.5 * (pa + pb);
            const EdgeQuadric sum = sum_of(a, b, 0.5 * (pb - pa));
            rest_[a] = {sum.g - sum.a.times(x), sum.at(x)};
        }
        if (!shape_.empty()) shape_[a] += shape_[b];
        mesh_.collapse(a, b, p);
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
    std::vector<float> weight_;
    std::vector<Symmetric> shape_;  ///< quadrics about their vertices; none where costs are lengths
    std::vector<Rest> rest_;        ///< where quadrics are inherited
    std::vector<float> key_;        ///< what joining the partner costs
    std::vector<std::int32_t> partner_;
    std::vector<State> state_;
    std::vector<std::int32_t> parent_;  ///< the vertex that each joined since gaps were last closed
    std::vector<std::int32_t> joined_;  ///< the vertex, as numbered then, that each of the first ones had joined
    std::vector<float> keys_;           ///< room for those that are finite
    std::vector<std::pair<double, std::int32_t>> offers_;
};

}  // namespace

std::vector<std::int32_t> collapse_in_passes(RingMesh& mesh, std::vector<float> weight,
                                             const CollapseOptions& options) {
    return Passes(mesh, std::move(weight), options).run();
}

}  // namespace gaussmap
