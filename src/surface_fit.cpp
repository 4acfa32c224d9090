#include "surface_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "face_frame.h"
#include "parallel.h"
#include "triangle_closest.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1 << 12, faces_grain = 1 << 9;
constexpr double straight = 0.998;  ///< of a vertex whose faces lie about in one plane: some 7° off on either side

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

/// Of weighted squared distances.
struct Mean {
    double squares = 0, area = 0;
    void add(double a, double squared) { squares += a * squared, area += a; }
};
double root_mean_square(const std::vector<Mean>& parts) {
    Mean sum;
    for (const Mean& part : parts) sum.squares += part.squares, sum.area += part.area;
    return sum.squares > 0 ? std::sqrt(sum.squares / sum.area) : 0;
}

/// Indices grouped by a number each, −1 being left out; in their order.
FaceSamples grouped(const std::vector<std::int32_t>& key, std::size_t groups) {
    FaceSamples rows;
    rows.begin.assign(groups + 2, 0);
    for (const std::int32_t k : key)
        if (k >= 0) ++rows.begin[k + 2];
    std::partial_sum(rows.begin.begin(), rows.begin.end(), rows.begin.begin());
    rows.items.resize(rows.begin.back());
    for (std::size_t i = 0; i < key.size(); ++i)
        if (key[i] >= 0) rows.items[rows.begin[key[i] + 1]++] = static_cast<std::int32_t>(i);
    rows.begin.pop_back();
    return rows;
}

/// The face closest to each of the samples near a vertex. Most are settled at the vertex, whose faces are looked at for
/// all of them.
void assign_near(const RingMesh& mesh, AreaSamples& samples, const FaceSamples& near, std::int32_t v,
                 std::vector<std::pair<std::int32_t, FaceFrame>>& ring, Mean& distance) {
    ring.clear();
    mesh.for_corners(v, [&](std::int32_t c) { ring.emplace_back(c / 3, frame_of(mesh, c / 3)); });
    std::size_t last = 0;  // the face of one will do for the next, often
    near.for_each(v, [&](std::int32_t i) {
        const Vec3 p = samples.point[i];
        for (std::size_t k = 0; k < ring.size(); ++k) {
            const std::size_t at = last + k < ring.size() ? last + k : last + k - ring.size();
            const FaceFrame::Foot foot = ring[at].second.foot(p);
            if (!ring[at].second.settled(foot)) continue;
            samples.face[i] = ring[at].first;
            distance.add(samples.area[i], foot.height * foot.height);
            last = at;
            return;
        }
        if (!ring.empty()) distance.add(samples.area[i], assign_around(mesh, samples, i, v));
    });
}

/// \param start  the vertex of the coarse mesh that each sample is near to.
void assign_first(const RingMesh& mesh, AreaSamples& samples, const std::vector<std::int32_t>& start,
                  const Execution& run) {
    samples.face.assign(samples.point.size(), -1);
    const std::size_t vertices = mesh.first.size();
    const FaceSamples near = grouped(start, vertices);
    std::vector<Mean> parts(block_count(vertices, faces_grain));
    for_blocks(vertices, faces_grain, {run.threads, {}}, [&](std::size_t b, std::size_t v, std::size_t end) {
        std::vector<std::pair<std::int32_t, FaceFrame>> ring;
        for (; v < end; ++v) assign_near(mesh, samples, near, static_cast<std::int32_t>(v), ring, parts[b]);
    });
    samples.rms = root_mean_square(parts);
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
    std::vector<std::int32_t> start(out.point.size());
    for (std::size_t i = 0; i < start.size(); ++i) start[i] = joined[i < n ? in.corners[3 * i] : bent[i - n]];
    assign_first(coarse, out, start, run);
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
    for (std::size_t c = 0; c < in.corners.size(); ++c)
        if (const std::int32_t f = centres.face[c / 3]; f >= 0) out.face[in.corners[c]] = f;
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

double assign_around(const RingMesh& mesh, FitSamples& samples, std::int32_t i, std::int32_t v) {
    Walk walk(mesh, samples.point[i]);
    walk.look_around(v);
    walk.descend();
    samples.face[i] = walk.face;
    return walk.hit.squared;
}

void assign(const RingMesh& mesh, AreaSamples& samples, const FaceSamples& rows, const Execution& run) {
    const std::size_t faces = mesh.tags.size();
    std::vector<Mean> parts(block_count(faces, faces_grain));
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
                parts[b].add(samples.area[i], squared);
            });
        }
    });
    samples.rms = root_mean_square(parts);
}

FaceSamples by_face(const FitSamples& samples, std::size_t faces) {
    return grouped(samples.face, faces);
}

}  // namespace gaussmap
