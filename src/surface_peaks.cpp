#include "surface_peaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "parallel.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1 << 9;
constexpr double part = 0.5;  ///< of the greatest height: what is higher is brought down before less is looked at

/// Heights are squared distances. One that is no more than `low` may be given as any that is not either.
class Peaks {
  public:
    Peaks(RingMesh& mesh, const AreaSamples& centres, VertexSamples& vertices, const FaceBoxes& fine)
        : mesh_(mesh),
          centres_(centres),
          vertices_(vertices),
          fine_(fine),
          rows_(by_face(centres, mesh.tags.size())),
          first_(mesh.tags.size(), -1),
          next_(vertices.face.size(), -1),
          squared_(vertices.squared_distance),
          height_(mesh.tags.size(), 0) {
        // As many points a face as the fine surface has faces to it, roughly.
        const double ratio = 0.5 * static_cast<double>(fine.corners.size()) / static_cast<double>(mesh.face_count());
        steps_ = std::clamp(static_cast<int>(std::sqrt(ratio)), 2, 8);
        for (int i = 0; i <= steps_; ++i)
            for (int j = 0; i + j <= steps_; ++j)
                grid_.push_back(
                    1.0 / steps_ *
                    Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(steps_ - i - j)});
    }

    std::size_t lower(const Execution& run) {
        std::size_t moves = 0;
        for (const std::size_t most = 256 + mesh_.face_count() / 16; moves < most;) {
            if (queue_.empty() && !find_heights(run)) break;
            const auto [height, face] = queue_.top();
            if (height != height_[face]) {
                queue_.pop();
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
        std::int32_t& first = first_[vertices_.face[sample]];
        next_[sample] = first;
        first = sample;
    }
    template <class Body>
    void for_samples(std::int32_t f, Body&& body) const {
        for (std::int32_t k = first_[f]; k >= 0; k = next_[k]) body(k);
    }

    /// The greatest distance on each face, both ways. \return whether there is one.
    bool find_heights(const Execution& run) {
        std::fill(first_.begin(), first_.end(), -1);
        low_ = 0;
        for (std::size_t i = squared_.size(); i-- > 0;)
            if (vertices_.face[i] >= 0) low_ = std::max(low_, part * squared_[i]), put(static_cast<std::int32_t>(i));
        const std::vector<double> apart = corners_apart(run);
        low_ = std::max(low_, part * *std::max_element(apart.begin(), apart.end()));
        for_blocks(height_.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t end) {
            for (; i < end; ++i) {
                const auto f = static_cast<std::int32_t>(i);
                height_[f] = there(f);
                const std::int32_t* v = &mesh_.vertex[3 * f];
                // Below what lies over it and is near, a face is near too: less than half as far, and little is missed.
                if (std::max({4 * height_[f], apart[v[0]], apart[v[1]], apart[v[2]]}) > low_ || !covered(f))
                    height_[f] = std::max(height_[f], back(f, corners(f), HUGE_VAL).squared);
            }
        });
        for (std::size_t f = 0; f < height_.size(); ++f)
            if (height_[f] > low_) queue_.push({height_[f], static_cast<std::int32_t>(f)});
        return !queue_.empty();
    }

    /// The heights of the vertices alone, exact where they come to `low_` of all.
    std::vector<double> corners_apart(const Execution& run) const {
        std::vector<double> apart(mesh_.first.size());
        for_blocks(apart.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t v, std::size_t end) {
            for (double enough = low_; v < end; ++v) {
                const Vec3 p = mesh_.position[v];
                apart[v] = closest_face(fine_, p, hit_of_sample(centres_.anchor[v], p), enough).squared;
                enough = std::max(enough, part * apart[v]);
            }
        });
        return apart;
    }

    /// Is there about as much of the fine surface over a face as it is large?
    bool covered(std::int32_t f) const {
        double area = 0;
        rows_.for_each(f, [&](std::int32_t i) { area += centres_.area[i]; });
        const auto [a, b, c] = corners(f);
        return area > 0.25 * length(cross(b - a, c - a));
    }

    std::array<Vec3, 3> corners(std::int32_t f) const {
        const std::int32_t* v = &mesh_.vertex[3 * f];
        return {mesh_.position[v[0]], mesh_.position[v[1]], mesh_.position[v[2]]};
    }
    TriangleHit from_face(std::int32_t f, Vec3 p) const {
        const auto [a, b, c] = corners(f);
        return closest_on_triangle(p, a, b, c);
    }

    /// From the fine surface to a face.
    double there(std::int32_t f) const {
        double most = 0;
        for_samples(f, [&](std::int32_t k) { most = std::max(most, squared_[k]); });
        return most;
    }

    struct Far {
        double squared = 0;
        std::int32_t face = -1;  ///< of the fine surface, the closest to …
        Vec3 from;               ///< … this place
    };
    /// The place of a triangle that is furthest from the fine surface; no more than is needed to see that it is at
    /// least `enough` away. \param near  the face of the coarse mesh that the triangle is, or might become.
    Far back(std::int32_t near, const std::array<Vec3, 3>& triangle, double enough) const {
        Far furthest;
        FaceHit last;
        for (const Vec3 w : grid_) {
            const Vec3 p = w.x * triangle[0] + w.y * triangle[1] + w.z * triangle[2];
            // Begin where the place before was, or with the nearest centre.
            last = hit_of(fine_, last.face, p);
            if (last.squared > low_) {
                Nearest nearest{p};
                look(near, nearest);
                const FaceHit other = guess(nearest);
                if (other.squared < last.squared) last = other;
            }
            last = closest_face(fine_, p, last, low_);
            if (last.squared > furthest.squared) furthest = {last.squared, last.face, p};
            if (furthest.squared >= enough) break;
        }
        return furthest;
    }
    /// The centre nearest to a place, which most often is of the fine face closest to it.
    struct Nearest {
        Vec3 to;
        double least = std::numeric_limits<double>::infinity();
        std::int32_t centre = -1;
    };
    /// Among those that had the face.
    void look(std::int32_t f, Nearest& nearest) const {
        rows_.for_each(f, [&](std::int32_t i) {
            if (3 * static_cast<std::size_t>(i) >= fine_.corners.size()) return;
            const double apart = squared(nearest.to - centres_.point[i]);
            if (apart < nearest.least) nearest.least = apart, nearest.centre = i;
        });
    }
    FaceHit guess(const Nearest& nearest) const { return hit_of(fine_, nearest.centre, nearest.to); }
    /// The face that a sample is the centre of, if it is one's.
    FaceHit hit_of_sample(std::int32_t sample, Vec3 p) const {
        return hit_of(fine_, 3 * static_cast<std::size_t>(sample) < fine_.corners.size() ? sample : -1, p);
    }

    /// The greatest distance around v, were it at p; no more than is needed to see that it is at least `enough`.
    double height_at(std::int32_t v, Vec3 p, double enough) {
        ring_.clear();
        mesh_.for_corners(v, [&](std::int32_t c) {
            ring_.push_back({p, mesh_.position[mesh_.vertex[RingMesh::after(c)]],
                             mesh_.position[mesh_.vertex[RingMesh::before(c)]]});
        });
        double most = 0;
        mesh_.for_corners(v, [&](std::int32_t c) {
            for_samples(c / 3, [&](std::int32_t k) {
                if (most >= enough) return;
                double least = std::numeric_limits<double>::infinity();
                for (const auto& [a, s, t] : ring_)
                    least = std::min(least, closest_on_triangle(vertices_.point[k], a, s, t).squared);
                // It may be nearer to a face further out, as it was before.
                most = std::max(most, least);
            });
        });
        std::size_t i = 0;
        mesh_.for_corners(v, [&](std::int32_t c) {
            const std::array<Vec3, 3>& triangle = ring_[i++];
            if (most < enough) most = std::max(most, back(c / 3, triangle, enough).squared);
        });
        return most;
    }

    /// From the point around v that is furthest from the fine surface, to there.
    Vec3 way_back(std::int32_t v) const {
        Far furthest;
        mesh_.for_corners(v, [&](std::int32_t c) {
            const Far far = back(c / 3, corners(c / 3), HUGE_VAL);
            if (far.squared > furthest.squared) furthest = far;
        });
        if (furthest.face < 0) return {};
        const std::int32_t* e = &fine_.corners[3 * furthest.face];
        const Vec3 a = fine_.positions[e[0]], b = fine_.positions[e[1]], c = fine_.positions[e[2]];
        const TriangleHit hit = closest_on_triangle(furthest.from, a, b, c);
        return hit.u * a + hit.v * b + hit.w * c - furthest.from;
    }

    /// From the ring around v to the sample that is furthest from it.
    Vec3 way_out(std::int32_t v) const {
        Vec3 way;
        double furthest = 0;
        mesh_.for_corners(v, [&](std::int32_t corner) {
            for_samples(corner / 3, [&](std::int32_t k) {
                if (squared_[k] <= furthest) return;
                furthest = squared_[k];
                const auto [a, b, c] = corners(corner / 3);
                const TriangleHit hit = closest_on_triangle(vertices_.point[k], a, b, c);
                way = vertices_.point[k] - (hit.u * a + hit.v * b + hit.w * c);
            });
        });
        return way;
    }

    bool improve(std::int32_t v) {
        if (mesh_.kind[v] != VertexKind::free) return false;
        const Vec3 at = mesh_.position[v], out = way_out(v), back_there = way_back(v);
        const double before = height_at(v, at, HUGE_VAL);
        double best = before;
        Vec3 place = at;
        for (const Vec3 step : {0.25 * out, 0.5 * out, out, 1.5 * out, 0.25 * back_there, 0.5 * back_there, back_there,
                                1.5 * back_there, 0.5 * (back_there + out)}) {
            const Vec3 p = at + step;
            if (mesh_.folds(v, p)) continue;
            const double height = height_at(v, p, best);
            if (height < 0.96 * best) best = height, place = p;
        }
        if (best >= before) return false;
        mesh_.position[v] = place;
        reassign(v);
        mesh_.for_corners(v, [&](std::int32_t c) {
            const std::int32_t f = c / 3;
            height_[f] = std::max(there(f), back(f, corners(f), HUGE_VAL).squared);
            if (height_[f] > low_) queue_.push({height_[f], f});
        });
        return true;
    }

    /// The samples of the faces around v, within these.
    void reassign(std::int32_t v) {
        met_.clear();
        mesh_.for_corners(v, [&](std::int32_t c) {
            for_samples(c / 3, [&](std::int32_t k) { met_.push_back(k); });
            first_[c / 3] = -1;
        });
        for (const std::int32_t k : met_) {
            squared_[k] = std::numeric_limits<double>::infinity();
            mesh_.for_corners(v, [&](std::int32_t c) {
                const double found = from_face(c / 3, vertices_.point[k]).squared;
                if (found < squared_[k]) squared_[k] = found, vertices_.face[k] = c / 3;
            });
            put(k);
        }
    }

    RingMesh& mesh_;
    const AreaSamples& centres_;
    VertexSamples& vertices_;
    const FaceBoxes& fine_;
    FaceSamples rows_;                        ///< the centres of each face as it was
    std::vector<std::int32_t> first_, next_;  ///< the first vertex of each face, and the next of the same face
    std::vector<double>& squared_;            ///< distance of each vertex
    std::vector<double> height_;              ///< of each face
    double low_ = 0;
    int steps_ = 0;           ///< of a side, in …
    std::vector<Vec3> grid_;  ///< weights of the points of a face from which distances are taken
    std::priority_queue<std::pair<double, std::int32_t>>
        queue_;  ///< faces by height, also those that have changed since
    std::vector<std::array<Vec3, 3>> ring_;
    std::vector<std::int32_t> met_;
};

}  // namespace

std::size_t lower_peaks(RingMesh& coarse, const AreaSamples& centres, VertexSamples& vertices, const FaceBoxes& fine,
                        const Execution& run) {
    return Peaks(coarse, centres, vertices, fine).lower(run);
}

}  // namespace gaussmap
