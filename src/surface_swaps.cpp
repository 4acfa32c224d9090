// Vertices moved from where they are needed least to where they help most.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "quadric.h"
#include "surface_fit.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

constexpr double margin = 0.7;       ///< of what a split gains, for a collapse to be worth it
constexpr double astray_weight = 5;  ///< as in surface_fit.cpp

struct Step {
    double value;  ///< of a collapse: what it costs; of a split: what it gains
    std::int32_t corner;
    bool operator<(const Step& other) const {
        return value != other.value ? value < other.value : corner < other.corner;
    }
};

class Swaps {
  public:
    Swaps(RingMesh& mesh, FitSamples& samples, const FitNorm& norm)
        : mesh_(mesh),
          samples_(samples),
          norm_(norm),
          rows_(by_face(samples, mesh.tags.size())),
          touched_(mesh.first.size(), false) {}

    std::size_t run(double share) {
        const std::size_t most =
            std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(mesh_.face_count()) / 2));
        std::vector<Step> splits = all_splits();
        std::sort(splits.rbegin(), splits.rend());
        const std::vector<Step> collapses = cheapest_collapses(4 * most);
        std::size_t swaps = 0, next_split = 0;
        for (const Step& collapse : collapses) {
            if (swaps >= most) break;
            // The next split that is still possible.
            while (next_split < splits.size() && !split_possible(splits[next_split].corner)) ++next_split;
            if (next_split == splits.size() || collapse.value > margin * splits[next_split].value) break;
            // Ends of the split must not be touched by the collapse.
            const std::int32_t a = mesh_.vertex[RingMesh::after(collapse.corner)],
                               b = mesh_.vertex[RingMesh::before(collapse.corner)];
            if (!untouched_around(a) || !untouched_around(b)) continue;
            const std::int32_t split = splits[next_split].corner;
            if (near(split, a) || near(split, b)) continue;
            const Vec3 p = meeting_point(a, b);
            if (mesh_.refusal(a, b, false) != Refusal::none || mesh_.folds(a, b, p)) continue;
            const std::int32_t twin = mesh_.twin(collapse.corner);
            if (twin < 0) continue;
            touch(a), touch(b);
            displaced_.clear();
            const auto gather = [&](std::int32_t c) {
                rows_.for_each(c / 3, [&](std::int32_t k) { displaced_.push_back(k); });
            };
            mesh_.for_corners(a, gather);
            mesh_.for_corners(b, gather);
            const std::int32_t face = collapse.corner / 3, twin_face = twin / 3;
            const std::int32_t stays = mesh_.kind[b] > mesh_.kind[a] ? b : a, goes = stays == a ? b : a;
            mesh_.collapse(stays, goes, p);
            reassign(stays);
            displaced_.clear();
            gather(split), gather(mesh_.twin(split));
            split_at(split, goes, face, twin_face);
            reassign(goes);
            ++next_split, ++swaps;
        }
        return swaps;
    }

  private:
    std::vector<Step> all_splits() const {
        std::vector<double> sum(mesh_.vertex.size(), 0), square(mesh_.vertex.size(), 0);
        for (std::size_t f = 0; f < mesh_.tags.size(); ++f) {
            if (mesh_.vertex[3 * f] < 0) continue;
            const std::int32_t* v = &mesh_.vertex[3 * f];
            const Vec3 a = mesh_.position[v[0]], b = mesh_.position[v[1]], c = mesh_.position[v[2]];
            const Vec3 n = cross(b - a, c - a);
            const double l = length(n);
            if (!(l > 0)) continue;
            rows_.for_each(static_cast<std::int32_t>(f), [&](std::int32_t k) {
                const Vec3 w = samples_.weights[k];
                const double area = samples_.area[k] * norm_.weight(samples_.squared_distance[k]);
                const double r = dot(1 / l * n, samples_.point[k] - a);
                // A hat on the middle of the side opposite to a corner is 2 min of the other two's weights.
                const double hat[] = {2 * std::min(w.y, w.z), 2 * std::min(w.z, w.x), 2 * std::min(w.x, w.y)};
                for (std::size_t s = 0; s < 3; ++s)
                    sum[3 * f + s] += area * hat[s] * r, square[3 * f + s] += area * hat[s] * hat[s];
            });
        }
        std::vector<Step> steps;
        for (std::size_t i = 0; i < mesh_.vertex.size(); ++i) {
            const auto corner = static_cast<std::int32_t>(i);
            if (mesh_.vertex[i] < 0 || mesh_.tagged(corner)) continue;
            const std::int32_t twin = mesh_.twin(corner);
            if (twin < corner) continue;
            const double s = sum[i] + sum[twin], q = square[i] + square[twin];
            if (q > 0 && s != 0) steps.push_back({s * s / q, corner});
        }
        return steps;
    }

    /// Where a and b would meet: by the planes around them.
    Vec3 meeting_point(std::int32_t a, std::int32_t b) const {
        if (mesh_.kind[a] != mesh_.kind[b]) return mesh_.position[mesh_.kind[a] > mesh_.kind[b] ? a : b];
        return minimizer(planes(a) + planes(b), 0.5 * (mesh_.position[a] + mesh_.position[b]), 1e-3);
    }
    Quadric planes(std::int32_t v) const {
        Quadric sum;
        mesh_.for_corners(v, [&](std::int32_t c) {
            sum += triangle_quadric(mesh_.position[v], mesh_.position[mesh_.vertex[RingMesh::after(c)]],
                                    mesh_.position[mesh_.vertex[RingMesh::before(c)]], 1);
        });
        return sum;
    }

    /// What a vertex at p far from the sample counts, as a surface of that area would.
    double astray(Vec3 p, std::int32_t sample, double area) const {
        const double excess = length(samples_.point[sample] - p) - std::sqrt(samples_.area[sample]);
        return excess > 0 ? area * norm_.cost(excess * excess) : 0;
    }
    double ring_area(std::int32_t v) const {
        double sum = 0;
        mesh_.for_corners(v, [&](std::int32_t c) {
            const Vec3 p = mesh_.position[v];
            sum += length(cross(mesh_.position[mesh_.vertex[RingMesh::after(c)]] - p,
                                mesh_.position[mesh_.vertex[RingMesh::before(c)]] - p)) /
                   6;
        });
        return sum;
    }

    /// Sides by what the collapse would really cost, of the `most` of least quadric cost.
    std::vector<Step> cheapest_collapses(std::size_t most) {
        std::vector<Step> steps;
        std::vector<Quadric> quadric(mesh_.first.size());
        std::vector<double> stray(quadric.size());
        for (std::size_t i = 0; i < quadric.size(); ++i) {
            const auto v = static_cast<std::int32_t>(i);
            quadric[i] = planes(v);
            stray[i] = astray(mesh_.position[i], samples_.anchor[i], astray_weight * ring_area(v));
        }
        for (std::size_t i = 0; i < mesh_.vertex.size(); ++i) {
            const auto corner = static_cast<std::int32_t>(i);
            if (mesh_.vertex[i] < 0 || mesh_.tagged(corner)) continue;
            const std::int32_t a = mesh_.vertex[RingMesh::after(corner)], b = mesh_.vertex[RingMesh::before(corner)];
            if (mesh_.kind[a] != VertexKind::free && mesh_.kind[b] != VertexKind::free) continue;
            if (mesh_.twin(corner) < corner) continue;
            const Quadric sum = quadric[a] + quadric[b];
            const Vec3 p = mesh_.kind[a] != mesh_.kind[b]
                               ? mesh_.position[mesh_.kind[a] > mesh_.kind[b] ? a : b]
                               : minimizer(sum, 0.5 * (mesh_.position[a] + mesh_.position[b]), 1e-3);
            steps.push_back({sum.at(p) - stray[a] - stray[b], corner});
        }
        if (steps.size() > most) {
            std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(most), steps.end());
            steps.resize(most);
        }
        for (Step& step : steps) step.value = true_cost(step.corner);
        std::sort(steps.begin(), steps.end());
        return steps;
    }

    double true_cost(std::int32_t corner) {
        const std::int32_t a = mesh_.vertex[RingMesh::after(corner)], b = mesh_.vertex[RingMesh::before(corner)];
        const Vec3 p = meeting_point(a, b);
        ring_.clear();
        around_.clear();
        for (const std::int32_t v : {a, b}) {
            const std::int32_t other = v == a ? b : a;
            mesh_.for_corners(v, [&](std::int32_t c) {
                const std::int32_t s = mesh_.vertex[RingMesh::after(c)], t = mesh_.vertex[RingMesh::before(c)];
                const bool on_both = s == other || t == other;
                if (on_both && v == b) return;
                around_.push_back(c / 3);
                if (!on_both) ring_.push_back({mesh_.position[s], mesh_.position[t]});
            });
        }
        double change = 0;
        for (const std::int32_t f : around_)
            rows_.for_each(f, [&](std::int32_t k) {
                double least = std::numeric_limits<double>::infinity();
                for (const auto& [s, t] : ring_)
                    least = std::min(least, closest_on_triangle(samples_.point[k], p, s, t).squared);
                change += samples_.area[k] * (norm_.cost(least) - norm_.cost(samples_.squared_distance[k]));
            });
        std::int32_t nearest = samples_.anchor[a];
        double least = squared(samples_.point[nearest] - p);
        for (const std::int32_t f : around_)
            rows_.for_each(f, [&](std::int32_t k) {
                const double d = squared(samples_.point[k] - p);
                if (d < least) least = d, nearest = k;
            });
        const double area_a = astray_weight * ring_area(a), area_b = astray_weight * ring_area(b);
        return change + astray(p, nearest, area_a + area_b) - astray(mesh_.position[a], samples_.anchor[a], area_a) -
               astray(mesh_.position[b], samples_.anchor[b], area_b);
    }

    void reassign(std::int32_t v) {
        for (const std::int32_t k : displaced_) assign_around(mesh_, samples_, static_cast<std::size_t>(k), v);
    }

    bool untouched_around(std::int32_t v) const {
        bool untouched = !touched_[v];
        mesh_.for_corners(v, [&](std::int32_t c) {
            untouched = untouched && !touched_[mesh_.vertex[RingMesh::after(c)]] &&
                        !touched_[mesh_.vertex[RingMesh::before(c)]];
        });
        return untouched;
    }
    void touch(std::int32_t v) {
        touched_[v] = true;
        mesh_.for_corners(v, [&](std::int32_t c) {
            touched_[mesh_.vertex[RingMesh::after(c)]] = touched_[mesh_.vertex[RingMesh::before(c)]] = true;
        });
    }
    bool split_possible(std::int32_t corner) const {
        if (mesh_.vertex[corner] < 0) return false;
        const std::int32_t twin = mesh_.twin(corner);
        if (twin < 0) return false;
        for (const std::int32_t c : {corner, RingMesh::after(corner), RingMesh::before(corner), twin})
            if (touched_[mesh_.vertex[c]]) return false;
        return true;
    }
    /// Is v a corner of the side's faces, or joined to one?
    bool near(std::int32_t corner, std::int32_t v) const {
        const std::int32_t twin = mesh_.twin(corner);
        bool found = false;
        const auto compare = [&](std::int32_t w) {
            for (const std::int32_t c : {corner, RingMesh::after(corner), RingMesh::before(corner), twin})
                found |= mesh_.vertex[c] == w;
        };
        compare(v);
        mesh_.for_corners(v, [&](std::int32_t c) {
            compare(mesh_.vertex[RingMesh::after(c)]), compare(mesh_.vertex[RingMesh::before(c)]);
        });
        return found;
    }

    void split_at(std::int32_t corner, std::int32_t v, std::int32_t face, std::int32_t twin_face) {
        const std::int32_t twin = mesh_.twin(corner);
        const std::int32_t b = mesh_.vertex[RingMesh::after(corner)], c = mesh_.vertex[RingMesh::before(corner)];
        const std::int32_t a = mesh_.vertex[corner], d = mesh_.vertex[twin];
        const Vec3 middle = 0.5 * (mesh_.position[b] + mesh_.position[c]);
        for (const std::int32_t w : {a, b, c, d}) touched_[w] = true;
        // The height that suits the samples best, as in all_splits.
        double sum = 0, square = 0;
        Vec3 up;
        for (const std::int32_t k : {corner, twin}) {
            const std::int32_t f = k / 3;
            const std::int32_t* e = &mesh_.vertex[3 * f];
            const Vec3 n =
                cross(mesh_.position[e[1]] - mesh_.position[e[0]], mesh_.position[e[2]] - mesh_.position[e[0]]);
            const double l = length(n);
            up = up + 1 / l * n;
            rows_.for_each(f, [&](std::int32_t i) {
                const Vec3 w = samples_.weights[i];
                const double hat = 2 * (k % 3 == 0   ? std::min(w.y, w.z)
                                        : k % 3 == 1 ? std::min(w.z, w.x)
                                                     : std::min(w.x, w.y));
                const double area = samples_.area[i] * norm_.weight(samples_.squared_distance[i]);
                sum += area * hat * dot(1 / l * n, samples_.point[i] - mesh_.position[e[0]]);
                square += area * hat * hat;
            });
        }
        const double l = length(up);
        Vec3 p = middle;
        if (l > 0 && square > 0)
            for (int halvings = 0; halvings < 4; ++halvings) {
                p = middle + std::ldexp(sum / square / l, -halvings) * up;
                if (fits(a, b, c, p) && fits(d, c, b, p)) break;
                p = middle;
            }
        mesh_.split(corner, twin, p, v, face, twin_face);
    }
    /// (a, b, c) as (a, b, p) and (a, p, c).
    bool fits(std::int32_t a, std::int32_t b, std::int32_t c, Vec3 p) const {
        const Vec3 pa = mesh_.position[a], pb = mesh_.position[b], pc = mesh_.position[c];
        return !turns_over(pa, pb, pc, pa, pb, p) && !turns_over(pa, pb, pc, pa, p, pc);
    }

    RingMesh& mesh_;
    FitSamples& samples_;
    FitNorm norm_;
    FaceSamples rows_;
    std::vector<bool> touched_;
    std::vector<std::int32_t> displaced_, around_;
    std::vector<std::pair<Vec3, Vec3>> ring_;
};

}  // namespace

std::size_t swap_vertices(RingMesh& mesh, FitSamples& samples, const FitNorm& norm, double share) {
    return Swaps(mesh, samples, norm).run(share);
}

}  // namespace gaussmap
