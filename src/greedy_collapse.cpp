#include "greedy_collapse.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "parallel.h"
#include "quadric.h"

namespace gaussmap {
namespace {

/// How firmly the best position is held to the middle of the edge, where the quadric is flat.
constexpr double pull = 1e-5;
/// What an edge of length l costs on a plane, as a squared distance over l²: short edges go first there.
constexpr double flat_cost = 1e-9;
/// Costs are taken in steps of this ratio, and within a step the vertices in their order, which is that of space:
/// memory is read along, not at random, and no heap is kept.
constexpr double step_ratio = 1.1;
/// Vertices to a block: those whose least key is above the limit are passed over.
constexpr std::size_t block = 64;
constexpr double never = std::numeric_limits<double>::infinity();

class Greedy {
  public:
    Greedy(RingMesh& mesh, std::vector<double> weight, const GreedyOptions& options)
        : mesh_(mesh),
          options_(options),
          weight_(std::move(weight)),
          quadric_(options.cost == CollapseCost::length ? 0 : mesh.first.size()),
          partner_(mesh.first.size(), -1),
          state_(mesh.first.size(), fresh),
          parent_(mesh.first.size()),
          key_(first_keys()) {
        for (std::size_t v = 0; v < parent_.size(); ++v) parent_[v] = static_cast<std::int32_t>(v);
        ring_.reserve(64);
    }

    std::vector<std::int32_t> run() {
        const auto span = static_cast<double>(mesh_.face_count() - std::min(mesh_.face_count(), options_.faces));
        const double start = static_cast<double>(mesh_.face_count());
        least_.resize((key_.size() + block - 1) / block, 0);
        for (double limit = 0; mesh_.face_count() > options_.faces;) {
            double least = never;
            for (std::size_t b = 0; b < least_.size(); ++b) {
                if (least_[b] <= limit) serve_block(b, limit);
                least = std::min(least, least_[b]);
                if (mesh_.face_count() <= options_.faces) return std::move(parent_);
            }
            if (least == never) break;
            limit = std::max(least * step_ratio, limit * step_ratio);
            if (options_.run.progress &&
                !options_.run.progress((start - static_cast<double>(mesh_.face_count())) / span))
                throw Cancelled();
        }
        return std::move(parent_);
    }

  private:
    void serve_block(std::size_t b, double limit) {
        const std::size_t end = std::min((b + 1) * block, key_.size());
        for (std::size_t v = b * block; v < end; ++v)
            if (key_[v] <= limit) serve(static_cast<std::int32_t>(v), limit);
        least_[b] = *std::min_element(key_.begin() + static_cast<std::ptrdiff_t>(b * block),
                                      key_.begin() + static_cast<std::ptrdiff_t>(end));
    }

    void set_key(std::int32_t v, double key) {
        key_[v] = key;
        double& least = least_[static_cast<std::size_t>(v) / block];
        least = std::min(least, key);
    }

    /// Collapse v with its partner as long as that costs no more than the limit.
    void serve(std::int32_t v, double limit) {
        while (key_[v] <= limit && mesh_.first[v] >= 0 && mesh_.face_count() > options_.faces) {
            if (state_[v] == stale) {
                choose(v);
                continue;
            }
            const std::int32_t w = partner_[v];
            const Vec3 p = candidate(v, w).position;
            if (!valid(v, w, p)) {
                choose_valid(v);
                continue;
            }
            join(v, w, p);
            return;
        }
    }

    enum State : std::uint8_t {
        fresh,
        stale,   ///< something has changed since the key was made: it bounds the cost from below
        checked  ///< the partner is the best of those with which the collapse was valid
    };
    struct Candidate {
        double cost = never;
        Vec3 position;
    };

    std::vector<double> first_keys() {
        const std::size_t count = mesh_.first.size();
        std::vector<double> keys(count, never);
        for_blocks(quadric_.size(), 1 << 13, {options_.run.threads, {}},
                   [&](std::size_t, std::size_t begin, std::size_t end) {
                       for (std::size_t v = begin; v < end; ++v) quadric_[v] = quadric_of(static_cast<std::int32_t>(v));
                   });
        for_blocks(count, 1 << 13, {options_.run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                const auto [cost, partner] = best(static_cast<std::int32_t>(v));
                keys[v] = cost, partner_[v] = partner;
            }
        });
        return keys;
    }

    /// Planes of the faces around v, and planes on the tagged sides that end in it, upright on their faces.
    Quadric quadric_of(std::int32_t v) const {
        Quadric sum;
        const Vec3 p = mesh_.position[v];
        mesh_.for_corners(v, [&](std::int32_t c) {
            const std::int32_t n = RingMesh::after(c), q = RingMesh::before(c);
            const Vec3 s = mesh_.position[mesh_.vertex[n]], t = mesh_.position[mesh_.vertex[q]];
            sum += triangle_quadric(p, s, t, 1);
            if (mesh_.kind[v] == VertexKind::free) return;
            if (mesh_.tagged(q)) sum += side_quadric(p, s, t);
            if (mesh_.tagged(n)) sum += side_quadric(t, p, s);
        });
        const double w = weight_[v];
        sum.xx *= w, sum.xy *= w, sum.xz *= w, sum.yy *= w, sum.yz *= w, sum.zz *= w, sum.b = w * sum.b, sum.c *= w;
        return sum;
    }

    /// Side a–b of the face (a, b, c): weight |b − a|², as for the area of the surface that it ends.
    Quadric side_quadric(Vec3 a, Vec3 b, Vec3 c) const {
        const Vec3 upright = cross(cross(b - a, c - a), b - a);
        const double l = squared(upright);
        return l > 0 ? plane_quadric(upright, a, options_.border_weight * squared(b - a) / l) : Quadric();
    }

    Candidate candidate(std::int32_t a, std::int32_t b) const {
        const VertexKind ka = mesh_.kind[a], kb = mesh_.kind[b];
        const Vec3 pa = mesh_.position[a], pb = mesh_.position[b], middle = 0.5 * (pa + pb);
        const bool stay = ka != kb, both_stay = ka == VertexKind::corner && kb == VertexKind::corner;
        if (both_stay) return {};
        const Vec3 stiff = ka > kb ? pa : pb;
        if (options_.cost == CollapseCost::length)
            return {0.5 * (weight_[a] + weight_[b]) * length(pb - pa), stay ? stiff : middle};
        const Quadric sum = quadric_[a] + quadric_[b];
        const Vec3 p = stay ? stiff : minimizer(sum, middle, pull);
        return {sum.at(p) + flat_cost * sum.trace() * squared(pb - pa), p};
    }

    bool valid(std::int32_t a, std::int32_t b, Vec3 p) {
        return mesh_.refusal(a, b, options_.allow_topology) == Refusal::none && !mesh_.folds(a, b, p);
    }

    /// The cheapest partner of v, ties by index.
    std::pair<double, std::int32_t> best(std::int32_t v) const {
        std::pair<double, std::int32_t> found{never, -1};
        mesh_.for_corners(v, [&](std::int32_t c) {
            // On a closed fan every neighbour comes after v in one face.
            const std::int32_t n = mesh_.vertex[RingMesh::after(c)];
            found = std::min(found, {candidate(v, n).cost, n});
            if (mesh_.kind[v] == VertexKind::free) return;
            const std::int32_t q = mesh_.vertex[RingMesh::before(c)];
            found = std::min(found, {candidate(v, q).cost, q});
        });
        return found;
    }

    void choose(std::int32_t v) {
        const auto [cost, partner] = best(v);
        partner_[v] = partner;
        state_[v] = fresh;
        set_key(v, cost);
    }

    /// The cheapest partner with which the collapse is valid.
    void choose_valid(std::int32_t v) {
        ring_.clear();
        mesh_.for_neighbors(v, [&](std::int32_t w) { ring_.push_back({candidate(v, w).cost, w}); });
        std::sort(ring_.begin(), ring_.end());
        double key = never;
        partner_[v] = -1;
        for (const auto& [cost, w] : ring_) {
            if (cost == never || !valid(v, w, candidate(v, w).position)) continue;
            key = cost, partner_[v] = w;
            break;
        }
        state_[v] = checked;
        set_key(v, key);
    }

    void join(std::int32_t a, std::int32_t b, Vec3 p) {
        // The one of the lower number stays, whichever side asked.
        if (b < a) std::swap(a, b);
        const double ta = quadric_.empty() ? 1 : quadric_[a].trace(), tb = quadric_.empty() ? 1 : quadric_[b].trace();
        const bool grows = options_.cost == CollapseCost::inherited;
        if (grows) quadric_[a] += quadric_[b];
        weight_[a] = ta + tb > 0 ? (ta * weight_[a] + tb * weight_[b]) / (ta + tb) : weight_[a];
        mesh_.collapse(a, b, p);
        parent_[b] = a;
        set_key(b, never);
        ring_.clear();
        mesh_.for_neighbors(a, [&](std::int32_t w) { ring_.push_back({0, w}); });
        if (grows) {
            await_growth(a, b, p);
            return;
        }
        if (options_.cost == CollapseCost::present) {
            quadric_[a] = quadric_of(a);
            for (const auto& [_, w] : ring_) quadric_[w] = quadric_of(w);
        }
        std::pair<double, std::int32_t> own{never, -1};
        for (auto& [cost, w] : ring_) {
            cost = candidate(a, w).cost;
            own = std::min(own, {cost, w});
        }
        partner_[a] = own.second;
        state_[a] = fresh;
        set_key(a, own.first);
        for (const auto& [cost, w] : ring_) {
            if (partner_[w] == a || partner_[w] == b || state_[w] == checked) {
                choose(w);
            } else if (cost < key_[w]) {
                partner_[w] = a, state_[w] = fresh;
                set_key(w, cost);
            } else if (options_.cost == CollapseCost::present) {
                state_[w] = stale;
            }
        }
    }

    /// Quadrics that only grow make keys that only grow: what changed is chosen anew when its turn comes, and each side
    /// of `a`, which b joined at p, when the turn of `a` does.
    void await_growth(std::int32_t a, std::int32_t b, Vec3 p) {
        set_key(a, quadric_[a].at(p));
        state_[a] = stale;
        for (const auto& [_, w] : ring_) {
            if (state_[w] == checked)
                choose(w);
            else if (partner_[w] == a || partner_[w] == b)
                state_[w] = stale;
        }
    }

    RingMesh& mesh_;
    const GreedyOptions& options_;
    std::vector<double> weight_;
    std::vector<Quadric> quadric_;  ///< a vertex; none where costs are lengths
    std::vector<std::int32_t> partner_;
    std::vector<State> state_;
    std::vector<std::int32_t> parent_;
    std::vector<std::pair<double, std::int32_t>> ring_;  ///< neighbours with costs, room used again
    std::vector<double> key_;                            ///< what joining the partner costs
    std::vector<double> least_;                          ///< of the keys of each block, or less
};

}  // namespace

std::vector<std::int32_t> collapse_cheapest(RingMesh& mesh, std::vector<double> weight, const GreedyOptions& options) {
    return Greedy(mesh, std::move(weight), options).run();
}

}  // namespace gaussmap
