// Sides flipped where the samples of their two faces come nearer.
#include <algorithm>
#include <array>

#include "face_frame.h"
#include "parallel.h"
#include "surface_fit.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 3 << 9;  ///< corners

/// 2 area / Σ edge²: 0.289 equilateral, 0 degenerate.
double shape_of(Vec3 a, Vec3 b, Vec3 c) {
    const double l = squared(b - a) + squared(c - b) + squared(a - c);
    return l > 0 ? length(cross(b - a, c - a)) / l : 0;
}

bool joined(const RingMesh& mesh, std::int32_t a, std::int32_t b) {
    bool found = false;
    mesh.for_corners(a, [&](std::int32_t c) {
        found |= mesh.vertex[RingMesh::after(c)] == b || mesh.vertex[RingMesh::before(c)] == b;
    });
    return found;
}

/// Faces (a, b, c) and (d, c, b), which may become (a, b, d) and (d, c, a).
struct Quad {
    std::int32_t corner, twin;
    Vec3 a, b, c, d;

    double shape() const { return std::min(shape_of(a, b, c), shape_of(d, c, b)); }
    double new_shape() const { return std::min(shape_of(a, b, d), shape_of(d, c, a)); }
    /// Neither new face may turn against either old one.
    bool folds() const {
        return turns_over(a, b, c, a, b, d) || turns_over(a, b, c, d, c, a) || turns_over(d, c, b, a, b, d) ||
               turns_over(d, c, b, d, c, a);
    }
};

Quad quad_of(const RingMesh& mesh, std::int32_t corner, std::int32_t twin) {
    const auto at = [&](std::int32_t c) { return mesh.position[mesh.vertex[c]]; };
    return {corner, twin, at(corner), at(RingMesh::after(corner)), at(RingMesh::before(corner)), at(twin)};
}

/// Where the diagonals pass each other, seen along where they are furthest apart: at b + along (c − b), the other at
/// `gap` from there.
struct Crossing {
    double along;
    Vec3 gap;
};
Crossing crossing_of(const Quad& q) {
    const Vec3 u = q.c - q.b, v = q.d - q.a, w = q.b - q.a;
    const double uu = squared(u), uv = dot(u, v), vv = squared(v), uw = dot(u, w), vw = dot(v, w);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return {-1, {}};
    const double along = (uv * vw - vv * uw) / determinant, across = (uu * vw - uv * uw) / determinant;
    return {along, across * v - w - along * u};
}

/// The twin of each corner whose side is not tagged, −1 without one.
std::vector<std::int32_t> twins_of(const RingMesh& mesh, const Execution& run) {
    std::vector<std::int32_t> twins(mesh.vertex.size(), -1);
    for_blocks(twins.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t c, std::size_t end) {
        for (; c < end; ++c) {
            const auto corner = static_cast<std::int32_t>(c);
            // Looked for from one of the two, which writes both: no slot is written twice.
            if (mesh.vertex[RingMesh::after(corner)] > mesh.vertex[RingMesh::before(corner)] || mesh.tagged(corner))
                continue;
            twins[c] = mesh.twin(corner);
            if (twins[c] >= 0) twins[twins[c]] = corner;
        }
    });
    return twins;
}

/// What is known of a side from the samples of one of its faces.
struct Outlook {
    double cost = 0;         ///< of the face's samples
    double gain = 0;         ///< what of it a flip would take away, to first order
    std::int32_t twin = -1;  ///< where a flip may be thought of
};

/// A flip lifts the surface of the quad by a tent: by the gap of the diagonals where they cross, by nothing on the
/// quad's sides, linear in between. With φ the tent of height 1 and r the residuals, Σ A r² falls by
/// 2 g Σ A φ r − g² Σ A φ².
std::array<Outlook, 3> outlooks(const RingMesh& mesh, const AreaSamples& samples, const FaceSamples& rows,
                                const std::vector<std::int32_t>& twins, std::int32_t f, const FitNorm& norm) {
    const std::int32_t* v = &mesh.vertex[3 * f];
    const FaceFrame frame(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]]);
    std::array<Outlook, 3> out;
    std::array<double, 3> per_from{}, per_to{}, gap{}, linear{}, square{};
    for (std::int32_t k = 0; k < 3; ++k) {
        const std::int32_t corner = 3 * f + k;
        const std::int32_t twin = twins[corner];
        if (twin < 0) continue;
        const Crossing crossing = crossing_of(quad_of(mesh, corner, twin));
        if (!(crossing.along > 0 && crossing.along < 1)) continue;
        per_from[k] = 1 / (1 - crossing.along), per_to[k] = 1 / crossing.along;
        gap[k] = dot(frame.normal, crossing.gap);
        out[k].twin = twin;
    }
    double cost = 0;
    rows.for_each(f, [&](std::int32_t i) {
        FaceFrame::Foot foot = frame.foot(samples.point[i]);
        double d = foot.height * foot.height;
        if (!foot.inside) {
            const TriangleHit hit =
                closest_on_triangle(samples.point[i], frame.corner[0], frame.corner[1], frame.corner[2]);
            d = hit.squared, foot.weights = {hit.u, hit.v, hit.w};
        }
        const double area = samples.area[i] * norm.weight(d);
        cost += area * d;
        for (std::size_t k = 0; k < 3; ++k) {
            const double tent =
                std::min(foot.weights[(k + 1) % 3] * per_from[k], foot.weights[(k + 2) % 3] * per_to[k]);
            linear[k] += area * tent * foot.height, square[k] += area * tent * tent;
        }
    });
    for (std::size_t k = 0; k < 3; ++k) out[k].cost = cost, out[k].gain = gap[k] * (2 * linear[k] - gap[k] * square[k]);
    return out;
}

/// Does a flip bring the samples nearer, or better triangles at the same distance?
bool worth_it(const Quad& q, const AreaSamples& samples, const FaceSamples& rows, const FitNorm& norm) {
    double before = 0, after = 0;
    const auto add = [&](std::int32_t k, Vec3 s, Vec3 t, Vec3 u) {
        const Vec3 p = samples.point[k];
        before += samples.area[k] * norm.cost(closest_on_triangle(p, s, t, u).squared);
        after += samples.area[k] * norm.cost(std::min(closest_on_triangle(p, q.a, q.b, q.d).squared,
                                                      closest_on_triangle(p, q.d, q.c, q.a).squared));
    };
    rows.for_each(q.corner / 3, [&](std::int32_t k) { add(k, q.a, q.b, q.c); });
    rows.for_each(q.twin / 3, [&](std::int32_t k) { add(k, q.d, q.c, q.b); });
    return after < 0.98 * before || (after <= 1.01 * before && q.new_shape() > 1.5 * q.shape());
}

/// Is the side opposite to a corner to be flipped? Its twin is asked nothing.
bool wants_flip(const RingMesh& mesh, const AreaSamples& samples, const FaceSamples& rows,
                const std::vector<Outlook>& outlook, std::int32_t corner, const FitNorm& norm) {
    const std::int32_t twin = outlook[corner].twin;
    if (twin < corner || mesh.vertex[corner] == mesh.vertex[twin]) return false;
    const double cost = outlook[corner].cost + outlook[twin].cost, gain = outlook[corner].gain + outlook[twin].gain;
    const Quad quad = quad_of(mesh, corner, twin);
    // What is not even likely is not tried.
    if (gain < 0.01 * cost && (gain < -0.05 * cost || quad.new_shape() <= 1.5 * quad.shape())) return false;
    return !quad.folds() && worth_it(quad, samples, rows, norm);
}

}  // namespace

std::size_t flip_sides(RingMesh& mesh, AreaSamples& samples, const FitNorm& norm, const Execution& run) {
    const FaceSamples rows = by_face(samples, mesh.tags.size());
    const std::vector<std::int32_t> twins = twins_of(mesh, run);
    std::vector<Outlook> outlook(mesh.vertex.size());
    for_blocks(mesh.tags.size(), grain / 3, {run.threads, {}}, [&](std::size_t, std::size_t f, std::size_t end) {
        for (; f < end; ++f) {
            const auto of_face = outlooks(mesh, samples, rows, twins, static_cast<std::int32_t>(f), norm);
            std::copy(of_face.begin(), of_face.end(), &outlook[3 * f]);
        }
    });
    std::vector<std::uint8_t> wanted(mesh.vertex.size());
    for_blocks(wanted.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t c, std::size_t end) {
        for (; c < end; ++c) wanted[c] = wants_flip(mesh, samples, rows, outlook, static_cast<std::int32_t>(c), norm);
    });
    std::vector<bool> done(mesh.tags.size(), false);
    std::size_t flips = 0;
    for (std::size_t i = 0; i < mesh.vertex.size(); ++i) {
        if (!wanted[i]) continue;
        const auto corner = static_cast<std::int32_t>(i);
        const std::int32_t twin = outlook[i].twin, a = mesh.vertex[corner];
        if (done[corner / 3] || done[twin / 3] || joined(mesh, a, mesh.vertex[twin])) continue;
        mesh.flip(corner, twin);
        for (const std::int32_t face : {corner / 3, twin / 3}) {
            done[face] = true;
            rows.for_each(face, [&](std::int32_t k) { assign_around(mesh, samples, k, a); });
        }
        ++flips;
    }
    return flips;
}

}  // namespace gaussmap
