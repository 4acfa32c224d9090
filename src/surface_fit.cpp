#include "surface_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "face_frame.h"
#include "local_quadric.h"
#include "parallel.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1 << 12, faces_grain = 1 << 9;
constexpr double overstep = 1.6;    ///< of a move that by itself is about half of what it could be
constexpr double pull = 1e-3;       ///< towards no move, where the samples leave a direction free
constexpr double straight = 0.998;  ///< of a vertex whose faces lie about in one plane: some 7° off on either side
constexpr double astray = 5;        ///< how much more than the fine surface a vertex that is far from it counts

FaceFrame frame_of(const RingMesh& mesh, std::int32_t f) {
    const std::int32_t* v = &mesh.vertex[3 * f];
    return {mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]]};
}

/// Walk from a face to closer ones, until none beside it is.
class Walk {
  public:
    Walk(const RingMesh& mesh, Vec3 p) : mesh_(mesh), p_(p) {}

    void look(std::int32_t f) {
        if (f == face) return;
        const std::int32_t* v = &mesh_.vertex[3 * f];
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
    bool settled() const {
        const std::int32_t* v = &mesh_.vertex[3 * face];
        const Vec3 a = mesh_.position[v[0]], b = mesh_.position[v[1]], c = mesh_.position[v[2]];
        return has_no_rival(hit.squared, {hit.u, hit.v, hit.w}, {squared(c - b), squared(a - c), squared(b - a)},
                            squared(cross(b - a, c - a)));
    }

    TriangleHit hit{};
    std::int32_t face = -1;

  private:
    const RingMesh& mesh_;
    Vec3 p_;
};

/// The face closest to each sample, from the vertex of the coarse mesh that start(sample) names.
template <class Start>
void assign_first(const RingMesh& mesh, FitSamples& samples, const Execution& run, Start&& start) {
    samples.face.assign(samples.point.size(), -1);
    for_blocks(samples.point.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t end) {
        std::int32_t before = -1;
        FaceFrame frame;
        for (; i < end; ++i) {
            const std::int32_t v = start(i);
            if (v < 0) continue;
            const Vec3 p = samples.point[i];
            // The one before is near: most often its face will do, if it is at the vertex.
            const std::int32_t* e = before < 0 ? nullptr : &mesh.vertex[3 * before];
            if (e && (e[0] == v || e[1] == v || e[2] == v) && frame.settled(frame.foot(p))) {
                samples.face[i] = before;
                continue;
            }
            Walk walk(mesh, p);
            walk.look_around(v);
            if (walk.face < 0) continue;
            walk.descend();
            if (walk.face != before) before = walk.face, frame = frame_of(mesh, before);
            samples.face[i] = before;
        }
    });
}

/// Vertices whose normal is shorter than those of their faces laid end to end, as where there are creases.
std::vector<std::int32_t> bent_vertices(const DecimationInput& in) {
    std::vector<Vec3> normal(in.positions.size());
    std::vector<double> lengths(in.positions.size(), 0);
    for (std::size_t c = 0; c < in.corners.size(); c += 3) {
        const std::int32_t* v = &in.corners[c];
        const Vec3 a = in.positions[v[0]], n = cross(in.positions[v[1]] - a, in.positions[v[2]] - a);
        const double l = length(n);
        for (int k = 0; k < 3; ++k) normal[v[k]] = normal[v[k]] + n, lengths[v[k]] += l;
    }
    std::vector<std::int32_t> bent;
    for (std::size_t v = 0; v < normal.size(); ++v)
        if (length(normal[v]) < straight * lengths[v]) bent.push_back(static_cast<std::int32_t>(v));
    return bent;
}

}  // namespace

AreaSamples area_samples(const DecimationInput& in, const std::vector<std::int32_t>& joined, const RingMesh& coarse,
                         const Execution& run) {
    const std::vector<std::int32_t> bent = bent_vertices(in);
    AreaSamples out;
    const std::size_t n = in.corners.size() / 3;
    out.point.reserve(n + bent.size());
    out.point.resize(n);
    out.area.resize(n + bent.size());
    for_blocks(n, grain, {run.threads, {}}, [&](std::size_t, std::size_t f, std::size_t end) {
        for (; f < end; ++f) {
            const std::int32_t* v = &in.corners[3 * f];
            const Vec3 a = in.positions[v[0]], b = in.positions[v[1]], c = in.positions[v[2]];
            out.point[f] = 1.0 / 3 * (a + b + c);
            out.area[f] = static_cast<float>(0.5 * length(cross(b - a, c - a)));
        }
    });
    if (!bent.empty()) {
        // Exact for quadratics: a twelfth of the area at each corner, the rest at the centre.
        std::vector<std::int32_t> sample(in.positions.size(), -1);
        for (const std::int32_t v : bent) {
            sample[v] = static_cast<std::int32_t>(out.point.size());
            out.point.push_back(in.positions[v]);
        }
        for (std::size_t f = 0; f < n; ++f) {
            const float share = out.area[f] / 12;
            for (std::size_t k = 0; k < 3; ++k)
                if (const std::int32_t at = sample[in.corners[3 * f + k]]; at >= 0)
                    out.area[at] += share, out.area[f] -= share;
        }
    }
    assign_first(coarse, out, run, [&](std::size_t i) { return joined[i < n ? in.corners[3 * i] : bent[i - n]]; });
    out.anchor.assign(coarse.first.size(), 0);
    for (std::size_t c = in.corners.size(); c-- > 0;)
        if (const std::int32_t v = joined[in.corners[c]]; v >= 0) out.anchor[v] = static_cast<std::int32_t>(c / 3);
    return out;
}

VertexSamples vertex_samples(const DecimationInput& in, const AreaSamples& centres, const RingMesh& coarse,
                             const Execution& run) {
    VertexSamples out;
    out.point = in.positions;
    out.face.assign(out.point.size(), -1);
    out.squared_distance.assign(out.point.size(), HUGE_VAL);
    for (std::size_t c = 0; c < in.corners.size(); ++c) {
        const std::int32_t v = in.corners[c], f = centres.face[c / 3];
        if (f < 0 || f == out.face[v]) continue;
        Walk walk(coarse, out.point[v]);
        walk.look(f);
        if (walk.hit.squared < out.squared_distance[v]) out.squared_distance[v] = walk.hit.squared, out.face[v] = f;
    }
    for_blocks(out.point.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t end) {
        for (; i < end; ++i) {
            if (out.face[i] < 0) continue;
            Walk walk(coarse, out.point[i]);
            walk.look(out.face[i]);
            walk.descend();
            out.face[i] = walk.face, out.squared_distance[i] = walk.hit.squared;
        }
    });
    return out;
}

void assign_around(const RingMesh& mesh, FitSamples& samples, std::int32_t i, std::int32_t v) {
    Walk walk(mesh, samples.point[i]);
    walk.look_around(v);
    walk.descend();
    samples.face[i] = walk.face;
}

double assign(const RingMesh& mesh, AreaSamples& samples, const FaceSamples& rows, const Execution& run) {
    struct Part {
        double squares = 0, area = 0;
    };
    const std::size_t faces = mesh.tags.size();
    std::vector<Part> parts(block_count(faces, faces_grain));
    for_blocks(faces, faces_grain, {run.threads, {}}, [&](std::size_t b, std::size_t f, std::size_t end) {
        for (; f < end; ++f) {
            const auto face = static_cast<std::int32_t>(f);
            const FaceFrame frame = frame_of(mesh, face);
            rows.for_each(face, [&](std::int32_t i) {
                const FaceFrame::Foot foot = frame.foot(samples.point[i]);
                double squared = foot.height * foot.height;
                if (!frame.settled(foot)) {
                    Walk walk(mesh, samples.point[i]);
                    walk.look(face);
                    walk.descend();
                    samples.face[i] = walk.face;
                    squared = walk.hit.squared;
                }
                parts[b].squares += samples.area[i] * squared, parts[b].area += samples.area[i];
            });
        }
    });
    Part sum;
    for (const Part& part : parts) sum.squares += part.squares, sum.area += part.area;
    return sum.squares > 0 ? std::sqrt(sum.squares / sum.area) : 0;
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

/// What planes ask of a move x: that xᵀ A x − 2 b·x be small.
struct Planes {
    Symmetric a;
    Vec3 b;

    /// The plane through p of the unit normal n.
    void add(Vec3 n, Vec3 p, double weight) {
        a.add_normal(n, weight);
        b = b + weight * dot(n, p) * n;
    }
    Planes& operator+=(const Planes& other) {
        a += other.a, b = b + other.b;
        return *this;
    }
    /// The best move, held to none where the planes leave a direction free.
    Vec3 move() const {
        const double held = pull * a.trace();
        const Vec3 best = held > 0 ? HeldInverse(a, held).times(b) : Vec3{};
        return finite(best) ? best : Vec3{};
    }
};

/// What the samples of a face ask of one of its corners. Single precision will do: it is a step, taken again.
struct Wish {
    float xx, xy, xz, yy, yz, zz, x, y, z;  ///< planes, for the corner's move
    float most;                             ///< squared distance of the samples
    float nearest;                          ///< squared distance of the corner from …
    std::int32_t sample;                    ///< … the nearest of them; −1: none

    void take(const Planes& p) {
        const auto single = [](double a) { return static_cast<float>(a); };
        xx = single(p.a.xx), xy = single(p.a.xy), xz = single(p.a.xz), yy = single(p.a.yy), yz = single(p.a.yz);
        zz = single(p.a.zz), x = single(p.b.x), y = single(p.b.y), z = single(p.b.z);
    }
    Planes planes() const { return {{xx, xy, xz, yy, yz, zz}, {x, y, z}}; }
};

/// The residuals along their own directions, each taken as falling with a corner's weight at the closest point.
/// By convexity, Σ (r − Σ_j b_j x_j)² ≤ Σ_j Σ b_j (r − x_j)² for weights b_j that add up to 1, so that all vertices may
/// move at once. \param wish  three, of the corners.
void ask(const RingMesh& mesh, const AreaSamples& samples, const FaceSamples& rows, std::int32_t f, const FitNorm& norm,
         Wish* wish) {
    std::array<Planes, 3> planes;
    std::array<double, 3> nearest{HUGE_VAL, HUGE_VAL, HUGE_VAL};
    std::array<std::int32_t, 3> sample{-1, -1, -1};
    const FaceFrame frame = frame_of(mesh, f);
    double most = 0;
    std::array<double, 3> weights{}, heights{};  // of the samples that are straight above the face
    rows.for_each(f, [&](std::int32_t i) {
        const Vec3 p = samples.point[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const double apart = squared(p - frame.corner[k]);
            if (apart < nearest[k]) nearest[k] = apart, sample[k] = i;
        }
        const FaceFrame::Foot foot = frame.foot(p);
        if (foot.inside) {
            const double d = foot.height * foot.height, weight = samples.area[i] * norm.weight(d);
            most = std::max(most, d);
            for (std::size_t k = 0; k < 3; ++k)
                weights[k] += weight * foot.weights[k], heights[k] += weight * foot.weights[k] * foot.height;
            return;
        }
        const auto& [a, b, c] = frame.corner;
        const TriangleHit hit = closest_on_triangle(p, a, b, c);
        if (!(hit.squared > 0)) return;
        most = std::max(most, hit.squared);
        const double weight = samples.area[i] * norm.weight(hit.squared);
        const Vec3 r = p - (hit.u * a + hit.v * b + hit.w * c);
        const std::array<double, 3> shares{hit.u, hit.v, hit.w};
        for (std::size_t k = 0; k < 3; ++k)
            if (shares[k] > 0) planes[k].add(1 / std::sqrt(hit.squared) * r, r, weight * shares[k]);
    });
    for (std::size_t k = 0; k < 3; ++k) {
        if (weights[k] > 0) planes[k].add(frame.normal, heights[k] / weights[k] * frame.normal, weights[k]);
        wish[k].take(planes[k]);
        wish[k].most = static_cast<float>(most);
        wish[k].nearest = static_cast<float>(nearest[k]);
        wish[k].sample = sample[k];
    }
}

/// The sample nearest to v: the one that was, or one of its faces; where these have none, one that a neighbour had.
std::int32_t nearest_sample(const RingMesh& mesh, const AreaSamples& samples, const std::vector<Wish>& wish,
                            std::int32_t v) {
    std::int32_t nearest = samples.anchor[v];
    double least = squared(samples.point[nearest] - mesh.position[v]);
    bool alone = true;
    mesh.for_corners(v, [&](std::int32_t c) {
        alone = alone && wish[c].sample < 0;
        if (wish[c].sample >= 0 && wish[c].nearest < least) least = wish[c].nearest, nearest = wish[c].sample;
    });
    if (!alone) return nearest;
    mesh.for_corners(v, [&](std::int32_t c) {
        for (const std::int32_t k : {RingMesh::after(c), RingMesh::before(c)}) {
            const std::int32_t sample = samples.anchor[mesh.vertex[k]];
            const double apart = squared(samples.point[sample] - mesh.position[v]);
            if (apart < least) least = apart, nearest = sample;
        }
    });
    return nearest;
}

/// Where v goes.
Vec3 wanted_move(const RingMesh& mesh, const AreaSamples& samples, const std::vector<Wish>& wish, std::int32_t v,
                 std::int32_t anchor, const FitNorm& norm) {
    Planes sum;
    double ring_area = 0;  // a third of it
    double most = 0, shortest = HUGE_VAL;
    const Vec3 at = mesh.position[v];
    mesh.for_corners(v, [&](std::int32_t c) {
        const Vec3 s = mesh.position[mesh.vertex[RingMesh::after(c)]] - at,
                   t = mesh.position[mesh.vertex[RingMesh::before(c)]] - at;
        ring_area += length(cross(s, t)) / 6;
        shortest = std::min(shortest, squared(s));
        sum += wish[c].planes();
        most = std::max(most, static_cast<double>(wish[c].most));
    });
    // Back to the fine surface: no sample may feel a spike.
    const double spacing = std::sqrt(static_cast<double>(samples.area[anchor]));
    const Vec3 back = samples.point[anchor] - at;
    most = std::max(most, squared(back));
    const double d = length(back), excess = d - spacing;
    if (excess > 0) sum.add(1 / d * back, excess / d * back, astray * ring_area);
    // Weights that grow with the distances to be made small call for shorter steps.
    Vec3 move = overstep / (norm.power - 1) * sum.move();
    // No further than the surface is away, several times over where it is met askew, nor past a neighbour.
    const double bound = std::min(3 * std::sqrt(most), 0.3 * std::sqrt(shortest)), l = length(move);
    if (l > bound) move = bound / l * move;
    // Never far from every sample.
    const Vec3 off = move - back;
    const double away = length(off), trust = 3 / norm.scale + spacing;
    return away > trust ? back + trust / away * off : move;
}

}  // namespace

void move_vertices(RingMesh& mesh, AreaSamples& samples, const FaceSamples& rows, const FitNorm& norm,
                   const Execution& run) {
    std::vector<Wish> wish(mesh.vertex.size());
    for_blocks(mesh.tags.size(), faces_grain, {run.threads, {}}, [&](std::size_t, std::size_t f, std::size_t end) {
        for (; f < end; ++f) ask(mesh, samples, rows, static_cast<std::int32_t>(f), norm, &wish[3 * f]);
    });
    std::vector<Vec3> move(mesh.first.size());
    std::vector<std::int32_t> anchor(mesh.first.size());
    for_blocks(move.size(), faces_grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t end) {
        for (; i < end; ++i) {
            const auto v = static_cast<std::int32_t>(i);
            anchor[i] = nearest_sample(mesh, samples, wish, v);
            if (mesh.kind[i] == VertexKind::free) move[i] = wanted_move(mesh, samples, wish, v, anchor[i], norm);
        }
    });
    samples.anchor = std::move(anchor);
    for (std::size_t v = 0; v < move.size(); ++v)
        for (int halvings = 0; halvings < 3; ++halvings) {
            if (mesh.kind[v] != VertexKind::free) break;
            const Vec3 p = mesh.position[v] + std::ldexp(1.0, -halvings) * move[v];
            if (mesh.folds(static_cast<std::int32_t>(v), p)) continue;
            mesh.position[v] = p;
            break;
        }
}

}  // namespace gaussmap
