// The vertices moved at once to where the samples want them.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "face_frame.h"
#include "local_quadric.h"
#include "parallel.h"
#include "surface_fit.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1 << 9;
constexpr double pull = 5e-4;     ///< towards no move, where the samples leave a direction free
constexpr double astray = 5;      ///< how much more than the fine surface a vertex that is far from it counts
constexpr int squares_steps = 3;  ///< towards the best moves of all vertices together; one where weights follow moves

/// What planes ask of a move x: that xᵀ A x − 2 b·x be small.
class Planes {
  public:
    Symmetric a;
    Vec3 b;

    Planes() = default;
    Planes(const Symmetric& of_a, Vec3 of_b) : a(of_a), b(of_b) {}

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
        const double held = this->held();
        const Vec3 best = held > 0 ? HeldInverse(a, held).times(b) : Vec3{};
        return finite(best) ? best : Vec3{};
    }
    /// What is left to be asked for after the move x.
    Planes after(Vec3 x) const { return {a, b - a.times(x) - held() * x}; }

  private:
    double held() const { return pull * a.trace(); }
};

/// What the samples of a face ask of one of its corners. Single precision will do: it is a step, taken again.
struct Wish {
    float xx, xy, xz, yy, yz, zz, x, y, z;  ///< planes, for the corner's move
    float nearest;                          ///< squared distance of the corner from …
    std::int32_t sample;                    ///< … the nearest of them; −1: none

    void take(const Planes& p) {
        const auto single = [](double a) { return static_cast<float>(a); };
        xx = single(p.a.xx), xy = single(p.a.xy), xz = single(p.a.xz), yy = single(p.a.yy), yz = single(p.a.yz);
        zz = single(p.a.zz), x = single(p.b.x), y = single(p.b.y), z = single(p.b.z);
    }
    Planes planes() const { return {{xx, xy, xz, yy, yz, zz}, {x, y, z}}; }
};

/// What is known of a face beside the wishes for its corners.
struct Bond {
    float x, y, z;     ///< its normal
    float bc, ca, ab;  ///< Σ of the samples straight above it, each times the weights of two corners at its foot
    float most;        ///< squared distance of the samples
};

/// The residuals along their own directions, each taken as falling with a corner's weight at the closest point.
/// By convexity, Σ (r − Σ_j b_j x_j)² ≤ Σ_j Σ b_j (r − x_j)² for weights b_j that add up to 1, so that all vertices may
/// move at once; bonds tell what that leaves out. \param wish  three, of the corners.
Bond ask(const RingMesh& mesh, const AreaSamples& samples, const FaceSamples& rows, std::int32_t f, const FitNorm& norm,
         Wish* wish) {
    std::array<Planes, 3> planes;
    std::array<double, 3> nearest{HUGE_VAL, HUGE_VAL, HUGE_VAL};
    std::array<std::int32_t, 3> sample{-1, -1, -1};
    const FaceFrame frame = frame_of(mesh, f);
    double most = 0;
    std::array<double, 3> weights{}, heights{}, pairs{};  // of the samples that are straight above the face
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
            for (std::size_t k = 0; k < 3; ++k) {
                const double share = weight * foot.weights[k];
                weights[k] += share, heights[k] += share * foot.height;
                pairs[k] += weight * foot.weights[(k + 1) % 3] * foot.weights[(k + 2) % 3];
            }
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
        wish[k].nearest = static_cast<float>(nearest[k]);
        wish[k].sample = sample[k];
    }
    const auto single = [](double a) { return static_cast<float>(a); };
    return {single(frame.normal.x),
            single(frame.normal.y),
            single(frame.normal.z),
            single(pairs[0]),
            single(pairs[1]),
            single(pairs[2]),
            single(most)};
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

/// What is asked of v, also to come back to the fine surface: no sample may feel a spike.
Planes asked(const RingMesh& mesh, const AreaSamples& samples, const std::vector<Wish>& wish, std::int32_t v) {
    Planes sum;
    mesh.for_corners(v, [&](std::int32_t c) { sum += wish[c].planes(); });
    const std::int32_t anchor = samples.anchor[v];
    const Vec3 at = mesh.position[v], back = samples.point[anchor] - at;
    const double d = length(back), excess = d - std::sqrt(static_cast<double>(samples.area[anchor]));
    if (!(excess > 0)) return sum;
    double ring_area = 0;  // a third of it
    mesh.for_corners(v, [&](std::int32_t c) {
        ring_area += length(cross(mesh.position[mesh.vertex[RingMesh::after(c)]] - at,
                                  mesh.position[mesh.vertex[RingMesh::before(c)]] - at)) /
                     6;
    });
    sum.add(1 / d * back, excess / d * back, astray * ring_area);
    return sum;
}

/// Of what is asked of v after the moves x, the best further move.
Vec3 next_step(const RingMesh& mesh, const Planes& asked, const std::vector<Bond>& bonds, const std::vector<Vec3>& x,
               std::int32_t v) {
    Planes left = asked.after(x[v]);
    mesh.for_corners(v, [&](std::int32_t c) {
        const Bond& bond = bonds[c / 3];
        const Vec3 n{bond.x, bond.y, bond.z};
        const std::array<float, 3> pairs{bond.bc, bond.ca, bond.ab};
        const std::int32_t s = RingMesh::after(c), t = RingMesh::before(c);
        // What the others' moves do already, or undo.
        const double lack =
            pairs[t % 3] * dot(n, x[v] - x[mesh.vertex[s]]) + pairs[s % 3] * dot(n, x[v] - x[mesh.vertex[t]]);
        left.b = left.b + lack * n;
    });
    return left.move();
}

/// The moves that suit the samples of all faces together, by Chebyshev's semi-iteration. Golub, Varga, "Chebyshev
/// semi-iterative methods", 1961. Over its row sums, a matrix of products of such weights has its eigenvalues within
/// [1/4, 1]: Wathen, "Realistic eigenvalue bounds for the Galerkin mass matrix", 1987.
std::vector<Vec3> best_moves(const RingMesh& mesh, const std::vector<Planes>& asked, const std::vector<Bond>& bonds,
                             const FitNorm& norm, const Execution& run) {
    constexpr double least = 0.25, first_step = 2 / (least + 1), reach = (1 - least) / (1 + least);
    std::vector<Vec3> x(asked.size()), change(asked.size());
    const int steps = norm.power == 2 ? squares_steps : 1;
    double relaxed = 1;
    for (int step = 0; step < steps; ++step) {
        if (step > 0) relaxed = 1 / (1 - reach * reach * relaxed / (step == 1 ? 2 : 4));
        for_blocks(x.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t v, std::size_t end) {
            for (; v < end; ++v) {
                if (mesh.kind[v] != VertexKind::free) continue;
                const Vec3 further = next_step(mesh, asked[v], bonds, x, static_cast<std::int32_t>(v));
                // Weights that grow with the distances to be made small call for shorter steps.
                change[v] = relaxed * first_step / (norm.power - 1) * further + (relaxed - 1) * change[v];
            }
        });
        for (std::size_t v = 0; v < x.size(); ++v) x[v] = x[v] + change[v];
    }
    return x;
}

/// A move of v, no longer than is wise.
Vec3 limited(const RingMesh& mesh, const AreaSamples& samples, const std::vector<Bond>& bonds, std::int32_t v,
             Vec3 move, const FitNorm& norm) {
    double most = 0, shortest = HUGE_VAL;
    const Vec3 at = mesh.position[v];
    mesh.for_corners(v, [&](std::int32_t c) {
        shortest = std::min(shortest, squared(mesh.position[mesh.vertex[RingMesh::after(c)]] - at));
        most = std::max(most, static_cast<double>(bonds[c / 3].most));
    });
    const std::int32_t anchor = samples.anchor[v];
    const Vec3 back = samples.point[anchor] - at;
    most = std::max(most, squared(back));
    // No further than the surface is away, several times over where it is met askew, nor past a neighbour.
    const double bound = std::min(3 * std::sqrt(most), 0.3 * std::sqrt(shortest)), l = length(move);
    if (l > bound) move = bound / l * move;
    // Never far from every sample.
    const Vec3 off = move - back;
    const double away = length(off), trust = 3 / norm.scale + std::sqrt(static_cast<double>(samples.area[anchor]));
    return away > trust ? back + trust / away * off : move;
}

}  // namespace

void move_vertices(RingMesh& mesh, AreaSamples& samples, const FaceSamples& rows, const FitNorm& norm,
                   const Execution& run) {
    const auto in_blocks = [&](std::size_t count, auto&& body) {
        for_blocks(count, grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t end) {
            for (; i < end; ++i) body(static_cast<std::int32_t>(i));
        });
    };
    std::vector<Wish> wish(mesh.vertex.size());
    std::vector<Bond> bonds(mesh.tags.size());
    in_blocks(bonds.size(), [&](std::int32_t f) { bonds[f] = ask(mesh, samples, rows, f, norm, &wish[3 * f]); });
    std::vector<std::int32_t> anchor(mesh.first.size());
    in_blocks(anchor.size(), [&](std::int32_t v) { anchor[v] = nearest_sample(mesh, samples, wish, v); });
    samples.anchor = std::move(anchor);
    std::vector<Planes> planes(mesh.first.size());
    in_blocks(planes.size(), [&](std::int32_t v) {
        if (mesh.kind[v] == VertexKind::free) planes[v] = asked(mesh, samples, wish, v);
    });
    std::vector<Vec3> move = best_moves(mesh, planes, bonds, norm, run);
    in_blocks(move.size(), [&](std::int32_t v) {
        if (mesh.kind[v] == VertexKind::free) move[v] = limited(mesh, samples, bonds, v, move[v], norm);
    });
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
