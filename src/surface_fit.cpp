#include "surface_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "parallel.h"
#include "quadric.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1 << 12;
constexpr double overstep = 1.6;  ///< of a move that by itself is about half of what it could be
constexpr double pull = 1e-3;     ///< towards no move, where the samples leave a direction free
constexpr double astray = 5;      ///< how much more than the fine surface a vertex that is far from it counts

/// Walk from the sample's face to closer ones, until none beside it is.
class Walk {
  public:
    Walk(const RingMesh& mesh, Vec3 p) : mesh_(mesh), p_(p) {}

    void look(std::int32_t f) {
        if (f == face) return;
        const std::int32_t* v = &mesh_.vertex[3 * f];
        if (v[0] < 0) return;
        const TriangleHit found =
            closest_on_triangle(p_, mesh_.position[v[0]], mesh_.position[v[1]], mesh_.position[v[2]]);
        if (face < 0 || found.squared < hit.squared) hit = found, face = f;
    }
    void look_around(std::int32_t v) {
        mesh_.for_corners(v, [&](std::int32_t c) { look(c / 3); });
    }
    /// On to the faces around the nearest corner of the closest one, as long as one of them is closer.
    void descend() {
        for (std::int32_t at = -1; at != face && !settled();) {
            at = face;
            const std::array<double, 3> w{hit.u, hit.v, hit.w};
            look_around(mesh_.vertex[3 * at + (std::max_element(w.begin(), w.end()) - w.begin())]);
        }
    }

    TriangleHit hit{};
    std::int32_t face = -1;

  private:
    /// Further from every side of its face than from p, the closest point has no rival that does not fold back over it.
    bool settled() const {
        if (hit.u <= 0 || hit.v <= 0 || hit.w <= 0) return false;
        const std::int32_t* v = &mesh_.vertex[3 * face];
        const Vec3 a = mesh_.position[v[0]], b = mesh_.position[v[1]], c = mesh_.position[v[2]];
        const double nn = squared(cross(b - a, c - a));
        return hit.squared * squared(c - b) < hit.u * hit.u * nn && hit.squared * squared(a - c) < hit.v * hit.v * nn &&
               hit.squared * squared(b - a) < hit.w * hit.w * nn;
    }

    const RingMesh& mesh_;
    Vec3 p_;
};

void keep(FitSamples& samples, std::size_t i, const Walk& walk) {
    samples.face[i] = walk.face;
    samples.weights[i] = {walk.hit.u, walk.hit.v, walk.hit.w};
    samples.squared_distance[i] = walk.hit.squared;
}

}  // namespace

void assign_around(const RingMesh& mesh, FitSamples& samples, std::size_t i, std::int32_t v) {
    Walk walk(mesh, samples.point[i]);
    walk.look_around(v);
    walk.descend();
    keep(samples, i, walk);
}

void assign(const RingMesh& mesh, FitSamples& samples, const Execution& run) {
    for_blocks(samples.point.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (samples.face[i] < 0) continue;
            Walk walk(mesh, samples.point[i]);
            walk.look(samples.face[i]);
            walk.descend();
            keep(samples, i, walk);
        }
    });
}

FaceSamples by_face(const FitSamples& samples, std::size_t faces) {
    FaceSamples rows;
    rows.begin.assign(faces + 2, 0);
    for (const std::int32_t f : samples.face)
        if (f >= 0) ++rows.begin[f + 2];
    std::partial_sum(rows.begin.begin(), rows.begin.end(), rows.begin.begin());
    rows.items.resize(rows.begin.back());
    for (std::size_t i = 0; i < samples.face.size(); ++i)
        if (samples.face[i] >= 0) rows.items[rows.begin[samples.face[i] + 1]++] = static_cast<std::int32_t>(i);
    rows.begin.pop_back();
    return rows;
}

namespace {

/// Where v wants to go: the residuals along their own directions, each taken as falling with v's weight at its closest
/// point. By convexity, Σ (r − Σ_j b_j x_j)² ≤ Σ_j Σ b_j (r − x_j)² for weights b_j that add up to 1, so that all
/// vertices may move at once.
Vec3 wanted_move(const RingMesh& mesh, const FitSamples& samples, const FaceSamples& rows, std::int32_t v,
                 const FitNorm& norm) {
    Quadric sum;
    double ring_area = 0;  // a third of it
    double most = 0, shortest = HUGE_VAL;
    mesh.for_corners(v, [&](std::int32_t c) {
        const std::int32_t f = c / 3;
        const std::int32_t* e = &mesh.vertex[3 * f];
        Vec3 n = cross(mesh.position[e[1]] - mesh.position[e[0]], mesh.position[e[2]] - mesh.position[e[0]]);
        const double twice_area = length(n);
        ring_area += twice_area / 6;
        shortest = std::min(shortest, length(mesh.position[mesh.vertex[RingMesh::after(c)]] - mesh.position[v]));
        if (twice_area > 0) n = 1 / twice_area * n;
        for (std::int32_t k = rows.begin[f]; k < rows.begin[f + 1]; ++k) {
            const std::int32_t i = rows.items[k];
            const Vec3 weights = samples.weights[i];
            const double b = c % 3 == 0 ? weights.x : c % 3 == 1 ? weights.y : weights.z;
            if (b <= 0) continue;
            const Vec3 q =
                weights.x * mesh.position[e[0]] + weights.y * mesh.position[e[1]] + weights.z * mesh.position[e[2]];
            const Vec3 r = samples.point[i] - q;
            const double d = std::sqrt(samples.squared_distance[i]);
            most = std::max(most, samples.squared_distance[i]);
            const bool inside = weights.x > 0 && weights.y > 0 && weights.z > 0;
            const Vec3 along = inside || !(d > 0) ? n : 1 / d * r;
            const double weight = samples.area[i] * b * norm.weight(samples.squared_distance[i]);
            // Plane along·x = along·r for the move x.
            sum += plane_quadric(along, r, weight);
        }
    });
    // Back to the fine surface: no sample may feel a spike.
    const std::int32_t anchor = samples.anchor[v];
    const Vec3 back = samples.point[anchor] - mesh.position[v];
    most = std::max(most, squared(back));
    const double d = length(back), excess = d - std::sqrt(samples.area[anchor]);
    if (excess > 0) sum += plane_quadric(1 / d * back, excess / d * back, astray * ring_area);
    // Weights that grow with the distances to be made small call for shorter steps.
    Vec3 move = overstep / (norm.power - 1) * minimizer(sum, {}, pull);
    // No further than the surface is away, several times over where it is met askew, nor past a neighbour.
    const double bound = std::min(3 * std::sqrt(most), 0.3 * shortest), l = length(move);
    if (l > bound) move = bound / l * move;
    // Never far from every sample.
    const Vec3 off = move - back;
    const double away = length(off), trust = 3 / norm.scale + std::sqrt(samples.area[anchor]);
    return away > trust ? back + trust / away * off : move;
}

/// The sample nearest to each vertex, among those of its faces and those that its neighbours had.
void find_anchors(const RingMesh& mesh, FitSamples& samples, const FaceSamples& rows) {
    const std::vector<std::int32_t> before = samples.anchor;
    for (std::size_t i = 0; i < mesh.first.size(); ++i) {
        const Vec3 p = mesh.position[i];
        std::int32_t nearest = before[i];
        double least = squared(samples.point[nearest] - p);
        const auto look = [&](std::int32_t k) {
            const double d = squared(samples.point[k] - p);
            if (d < least) least = d, nearest = k;
        };
        mesh.for_corners(static_cast<std::int32_t>(i), [&](std::int32_t c) {
            look(before[mesh.vertex[RingMesh::after(c)]]);
            look(before[mesh.vertex[RingMesh::before(c)]]);
            rows.for_each(c / 3, look);
        });
        samples.anchor[i] = nearest;
    }
}

}  // namespace

void move_vertices(RingMesh& mesh, FitSamples& samples, const FitNorm& norm, const Execution& run) {
    const FaceSamples rows = by_face(samples, mesh.tags.size());
    find_anchors(mesh, samples, rows);
    std::vector<Vec3> move(mesh.first.size());
    for_blocks(move.size(), 1 << 9, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            if (mesh.kind[v] == VertexKind::free)
                move[v] = wanted_move(mesh, samples, rows, static_cast<std::int32_t>(v), norm);
    });
    for (std::size_t v = 0; v < move.size(); ++v)
        for (int halvings = 0; halvings < 3; ++halvings) {
            const Vec3 p = mesh.position[v] + std::ldexp(1.0, -halvings) * move[v];
            if (mesh.folds(static_cast<std::int32_t>(v), p)) continue;
            mesh.position[v] = p;
            break;
        }
}

FitSamples samples_of(const std::vector<Vec3>& positions, const std::vector<std::int32_t>& corners,
                      const std::vector<std::int32_t>& joined, const RingMesh& coarse) {
    FitSamples out;
    const std::size_t n = positions.size();
    out.point = positions;
    out.area.assign(n, 0);
    std::vector<std::int32_t> start = joined;
    for (std::size_t c = 0; c < corners.size(); c += 3) {
        const Vec3 a = positions[corners[c]], b = positions[corners[c + 1]], d = positions[corners[c + 2]];
        // Exact for quadratics: 1/12 a corner, 3/4 at the centre.
        const double area = 0.5 * length(cross(b - a, d - a));
        for (std::size_t k = 0; k < 3; ++k) out.area[corners[c + k]] += area / 12;
        out.point.push_back(1.0 / 3 * (a + b + d));
        out.area.push_back(0.75 * area);
        start.push_back(joined[corners[c]]);
    }
    out.face.assign(out.point.size(), -1);
    out.weights.resize(out.point.size());
    out.squared_distance.resize(out.point.size());
    for (std::size_t i = 0; i < out.point.size(); ++i) {
        if (start[i] < 0) continue;
        Walk walk(coarse, out.point[i]);
        walk.look_around(start[i]);
        if (walk.face < 0) continue;
        walk.descend();
        keep(out, i, walk);
    }
    out.anchor.assign(coarse.first.size(), 0);
    for (std::size_t i = n; i-- > 0;)
        if (joined[i] >= 0) out.anchor[joined[i]] = static_cast<std::int32_t>(i);
    return out;
}

}  // namespace gaussmap
