#include "surface_peaks.h"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>
#include <utility>

#include "triangle_closest.h"

namespace gaussmap {
namespace {

class Peaks {
  public:
    Peaks(RingMesh& mesh, FitSamples& samples, const ClosestIndex& fine, const Execution& run)
        : mesh_(mesh), samples_(samples), fine_(fine), run_({run.threads, {}}) {
        // As many points a face as the fine surface has faces to it, roughly.
        const double ratio = static_cast<double>(samples.face.size()) / static_cast<double>(1 + mesh.face_count());
        const int steps = std::clamp(static_cast<int>(std::sqrt(ratio)), 2, 8);
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; i + j <= steps; ++j)
                grid_.push_back(
                    1.0 / steps *
                    Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(steps - i - j)});
    }

    std::size_t lower(std::size_t most_steps) {
        first_.assign(mesh_.tags.size(), -1);
        next_.assign(samples_.face.size(), -1);
        for (std::size_t k = samples_.face.size(); k-- > 0;)
            if (samples_.face[k] >= 0) put(static_cast<std::int32_t>(k));
        find_heights();
        std::size_t moves = 0;
        for (std::size_t step = 0; step < most_steps && !queue_.empty(); ++step) {
            const auto [height, face] = queue_.top();
            queue_.pop();
            if (height != height_[face]) {
                --step;
                continue;
            }
            bool better = false;
            for (int k = 0; k < 3 && !better; ++k) better = improve(mesh_.vertex[3 * face + k]);
            for (int k = 0; k < 3 && !better; ++k) {
                const std::int32_t twin = mesh_.twin(3 * face + k);
                if (twin >= 0) better = improve(mesh_.vertex[twin]);
            }
            if (!better) break;
            ++moves;
        }
        return moves;
    }

  private:
    void put(std::int32_t sample) {
        std::int32_t& first = first_[samples_.face[sample]];
        next_[sample] = first;
        first = sample;
    }
    template <class Body>
    void for_samples(std::int32_t f, Body&& body) const {
        for (std::int32_t k = first_[f]; k >= 0; k = next_[k]) body(k);
    }

    /// The greatest distance on each face, both ways.
    void find_heights() {
        const std::size_t faces = mesh_.tags.size();
        std::vector<double> queries;
        queries.reserve(3 * grid_.size() * faces);
        for (std::size_t f = 0; f < faces; ++f) add_queries(static_cast<std::int32_t>(f), queries);
        const std::vector<double> back = fine_.distances(queries, run_);
        height_.resize(faces);
        std::vector<std::pair<double, std::int32_t>> order;
        for (std::size_t f = 0; f < faces; ++f) {
            height_[f] = height_of(static_cast<std::int32_t>(f), &back[grid_.size() * f]);
            order.push_back({height_[f], static_cast<std::int32_t>(f)});
        }
        queue_ = std::priority_queue<std::pair<double, std::int32_t>>(order.begin(), order.end());
    }
    void add_queries(Vec3 a, Vec3 b, Vec3 c, std::vector<double>& queries) const {
        for (const Vec3 w : grid_) {
            const Vec3 p = w.x * a + w.y * b + w.z * c;
            queries.insert(queries.end(), {p.x, p.y, p.z});
        }
    }
    void add_queries(std::int32_t f, std::vector<double>& queries) const {
        const auto [a, b, c] = corners(f);
        add_queries(a, b, c, queries);
    }
    double height_of(std::int32_t f, const double* back) const {
        double most = *std::max_element(back, back + grid_.size());
        most *= most;
        for_samples(f, [&](std::int32_t k) { most = std::max(most, samples_.squared_distance[k]); });
        return std::sqrt(most);
    }

    std::array<Vec3, 3> corners(std::int32_t f) const {
        const std::int32_t* v = &mesh_.vertex[3 * f];
        return {mesh_.position[v[0]], mesh_.position[v[1]], mesh_.position[v[2]]};
    }

    /// The greatest distance around v, were it at p; no more than is needed to see that it is at least `enough`.
    double height_at(std::int32_t v, Vec3 p, double enough) {
        ring_.clear();
        queries_.clear();
        mesh_.for_corners(v, [&](std::int32_t c) {
            const Vec3 s = mesh_.position[mesh_.vertex[RingMesh::after(c)]],
                       t = mesh_.position[mesh_.vertex[RingMesh::before(c)]];
            ring_.push_back({s, t});
            add_queries(p, s, t, queries_);
        });
        double most = 0;
        mesh_.for_corners(v, [&](std::int32_t c) {
            for_samples(c / 3, [&](std::int32_t k) {
                if (most >= enough * enough) return;
                double least = std::numeric_limits<double>::infinity();
                for (const auto& [s, t] : ring_)
                    least = std::min(least, closest_on_triangle(samples_.point[k], p, s, t).squared);
                // It may be nearer to a face further out, as it was before.
                most = std::max(most, least);
            });
        });
        most = std::sqrt(most);
        if (most >= enough) return most;
        const std::vector<double> back = fine_.distances(queries_, {1, {}});
        return std::max(most, *std::max_element(back.begin(), back.end()));
    }

    /// From the point around v that is furthest from the fine surface, to there.
    Vec3 way_back(std::int32_t v) {
        queries_.clear();
        mesh_.for_corners(v, [&](std::int32_t c) { add_queries(c / 3, queries_); });
        const ClosestPoints found = fine_.closest(queries_, {1, {}});
        const auto furthest = std::max_element(found.distance.begin(), found.distance.end()) - found.distance.begin();
        return load(&found.points[3 * furthest]) - load(&queries_[3 * furthest]);
    }

    bool improve(std::int32_t v) {
        if (mesh_.kind[v] != VertexKind::free) return false;
        const Vec3 at = mesh_.position[v];
        double best = height_at(v, at, std::numeric_limits<double>::infinity());
        const double before = best;
        Vec3 place = at;
        // Towards the sample that is furthest from the ring, and back to the fine surface.
        Vec3 pull;
        double furthest = -1;
        mesh_.for_corners(v, [&](std::int32_t c) {
            for_samples(c / 3, [&](std::int32_t k) {
                if (samples_.squared_distance[k] <= furthest) return;
                const auto [a, b, d] = corners(c / 3);
                const Vec3 w = samples_.weights[k];
                furthest = samples_.squared_distance[k];
                pull = samples_.point[k] - (w.x * a + w.y * b + w.z * d);
            });
        });
        const Vec3 back = way_back(v);
        for (const Vec3 step : {0.25 * pull, 0.5 * pull, pull, 1.5 * pull, 0.25 * back, 0.5 * back, back, 1.5 * back,
                                0.5 * (back + pull)}) {
            const Vec3 p = at + step;
            if (mesh_.folds(v, p)) continue;
            const double height = height_at(v, p, best);
            if (height < 0.98 * best) best = height, place = p;
        }
        if (best >= before) return false;
        mesh_.position[v] = place;
        reassign(v);
        queries_.clear();
        mesh_.for_corners(v, [&](std::int32_t c) { add_queries(c / 3, queries_); });
        const std::vector<double> distances = fine_.distances(queries_, {1, {}});
        std::size_t i = 0;
        mesh_.for_corners(v, [&](std::int32_t c) {
            height_[c / 3] = height_of(c / 3, &distances[grid_.size() * i++]);
            queue_.push({height_[c / 3], c / 3});
        });
        return true;
    }

    /// The samples of the faces around v, within these; `assign` finds others later.
    void reassign(std::int32_t v) {
        met_.clear();
        mesh_.for_corners(v, [&](std::int32_t c) {
            for_samples(c / 3, [&](std::int32_t k) { met_.push_back(k); });
            first_[c / 3] = -1;
        });
        for (const std::int32_t k : met_) {
            samples_.squared_distance[k] = std::numeric_limits<double>::infinity();
            mesh_.for_corners(v, [&](std::int32_t c) {
                const auto [p, s, t] = corners(c / 3);
                const TriangleHit hit = closest_on_triangle(samples_.point[k], p, s, t);
                if (hit.squared >= samples_.squared_distance[k]) return;
                samples_.face[k] = c / 3;
                samples_.squared_distance[k] = hit.squared;
                samples_.weights[k] = {hit.u, hit.v, hit.w};
            });
            put(k);
        }
    }

    RingMesh& mesh_;
    FitSamples& samples_;
    const ClosestIndex& fine_;
    Execution run_;
    std::vector<std::int32_t> first_, next_;  ///< the first sample of each face, and the next of the same face
    std::vector<Vec3> grid_;                  ///< weights of the points of a face from which distances are taken
    std::vector<double> height_;
    std::priority_queue<std::pair<double, std::int32_t>>
        queue_;  ///< faces by height, also those that have changed since
    std::vector<double> queries_;
    std::vector<std::int32_t> met_;
    std::vector<std::pair<Vec3, Vec3>> ring_;
};

}  // namespace

std::size_t lower_peaks(RingMesh& coarse, FitSamples& samples, const ClosestIndex& fine, std::size_t most_steps,
                        const Execution& run) {
    return Peaks(coarse, samples, fine, run).lower(most_steps);
}

}  // namespace gaussmap
