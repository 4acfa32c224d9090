// The steps of a decimation: what can be worked on, the cheapest collapses, the fit, and what the result came from.

#include "gaussmap/decimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "check.h"
#include "clock.h"
#include "collapse_passes.h"
#include "decimation_error.h"
#include "decimation_input.h"
#include "decimation_sources.h"
#include "face_boxes.h"
#include "gaussmap/curvature.h"
#include "gaussmap/distance.h"
#include "parallel.h"
#include "ring_mesh.h"
#include "surface_rounds.h"
#include "vec.h"

namespace gaussmap {
namespace {

void check(Points vertices, Triangles faces, const DecimateOptions& options) {
    check_faces(faces, vertices.count);
    if (!options.seams.empty()) check_count("seams", options.seams.size(), 3 * faces.count, "corners");
    if (!(options.feature_angle >= 0 && options.feature_angle <= 180))
        throw std::invalid_argument("feature_angle = " + std::to_string(options.feature_angle) +
                                    " is outside [0, 180]");
    if (!(options.error >= 0) || !std::isfinite(options.error))
        throw std::invalid_argument("error = " + std::to_string(options.error) + " must be finite and not negative");
}

/// √(density / median) of each vertex, or the root of that, held within a factor of 16 of 1 so that neither planes nor
/// creases rule alone.
std::vector<float> curvature_weights(const DecimationInput& in, bool fourth_root, const Execution& run) {
    std::vector<float> weight(in.positions.size(), 1);
    std::vector<double> sums(2 * in.positions.size());
    {
        const Points points = in.points();
        const std::vector<double> normals = mesh_normals(points, in.corners, NormalWeights::max, {run.threads, {}});
        vertex_density(points, in.corners, normals, sums.data(), {run.threads, {}});
    }
    std::vector<float> defined;
    for (std::size_t v = 0; v < weight.size(); ++v)
        if (const double d = sums[2 * v]; d > 0 && std::isfinite(d)) defined.push_back(static_cast<float>(d));
    if (defined.empty()) return weight;
    const auto middle = defined.begin() + static_cast<std::ptrdiff_t>(defined.size() / 2);
    std::nth_element(defined.begin(), middle, defined.end());
    for (std::size_t v = 0; v < weight.size(); ++v) {
        const double root = std::sqrt(sums[2 * v] / *middle);
        if (std::isfinite(root))
            weight[v] = static_cast<float>(std::clamp(fourth_root ? std::sqrt(root) : root, 1.0 / 16, 16.0));
    }
    return weight;
}

void tag_seams(RingMesh& mesh, const DecimationInput& in, const std::vector<std::uint8_t>& seams) {
    if (seams.empty()) return;
    for (std::size_t f = 0; f < in.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            if (!seams[3 * in.faces[f] + (k + in.rotation[f]) % 3]) continue;
            const auto corner = static_cast<std::int32_t>(3 * f + k);
            mesh.tag(corner);
            // Both faces know, whichever of them was told.
            if (const std::int32_t twin = mesh.twin(corner); twin >= 0) mesh.tag(twin);
        }
}

RingMesh tagged_mesh(const DecimationInput& in, const DecimateOptions& options) {
    RingMesh mesh(in.positions, in.corners);
    mesh.tag_irregular_sides();
    if (options.feature_angle < 180) mesh.tag_features(std::cos(options.feature_angle * std::numbers::pi / 180));
    tag_seams(mesh, in, options.seams);
    mesh.find_kinds();
    if (options.lock_border) std::replace(mesh.kind.begin(), mesh.kind.end(), VertexKind::curve, VertexKind::corner);
    return mesh;
}

std::vector<std::int32_t> collapse(RingMesh& mesh, const DecimationInput& in, const DecimateOptions& options) {
    CollapseOptions passes;
    passes.cost = options.method == DecimationMethod::edge  ? CollapseCost::length
                  : options.method == DecimationMethod::qem ? CollapseCost::inherited
                  // The fit mends what costs without a memory lose: thin parts.
                  : options.fast ? CollapseCost::carried
                                 : CollapseCost::present;
    passes.faces = options.faces;
    // Weights show in the order of collapses: the methods of the paper keep near to it, the fit levels what `best`
    // loses.
    if (options.method != DecimationMethod::best)
        passes.share = 0.02;
    else if (options.fast)
        passes.share = 0.2;
    passes.border_weight = options.preserve_boundary ? 1000 : 1;
    passes.allow_topology = options.allow_topology;
    passes.run = part_of(options.run, 0.05, 0.5);
    std::vector<float> weight = options.weights
                                    ? curvature_weights(in, options.method == DecimationMethod::best, options.run)
                                    : std::vector<float>(in.positions.size(), 1);
    return collapse_in_passes(mesh, std::move(weight), passes);
}

/// The sides that are left, counted by why they cannot collapse.
void count_refusals(RingMesh& mesh, bool allow_topology, Decimation& out) {
    RingMesh::Edge edge;
    for (std::size_t c = 0; c < mesh.vertex.size(); ++c) {
        const auto corner = static_cast<std::int32_t>(c);
        if (mesh.vertex[c] < 0) continue;
        const std::int32_t a = mesh.vertex[RingMesh::after(corner)], b = mesh.vertex[RingMesh::before(corner)];
        if (mesh.twin(corner) > corner) continue;  // met from the other face
        mesh.look(a, b, edge);
        switch (mesh.refusal(edge, allow_topology)) {
            case Refusal::locked:
                ++out.refused_locked;
                break;
            case Refusal::topology:
                ++out.refused_topology;
                break;
            default:
                ++out.refused_folding;
        }
    }
}

bool is_fitted(const DecimateOptions& options) {
    return options.method == DecimationMethod::best && !options.fast;
}

/// \param fine  boxes of the input's faces, where the result is fitted to them.
Decimation decimate_to_faces(const DecimationInput& in, const std::optional<FaceBoxes>& fine,
                             const DecimateOptions& options) {
    Decimation out;
    Lap watch;
    RingMesh coarse = tagged_mesh(in, options);
    const std::vector<std::int32_t> joined = collapse(coarse, in, options);
    if (coarse.face_count() > options.faces) {
        out.stop = DecimationStop::validity;
        count_refusals(coarse, options.allow_topology, out);
    }
    watch.add_to(out.seconds_collapse);
    const bool unchanged = coarse.face_count() == in.faces.size();
    const bool fitted = is_fitted(options) && !unchanged;
    if (fitted) bring_nearer(coarse, in, *fine, joined, options.objective, part_of(options.run, 0.5, 0.95));
    watch.add_to(out.seconds_fit);

    out.vertices.resize(3 * coarse.position.size());
    for (std::size_t v = 0; v < coarse.position.size(); ++v)
        store(&out.vertices[3 * v], in.centre + in.diagonal * coarse.position[v]);
    out.face_source.reserve(coarse.origin.size());
    for (const std::int32_t origin : coarse.origin) out.face_source.push_back(in.faces[origin]);
    if (options.sources) {
        out.vertex_source =
            fitted ? vertex_sources(in, *fine, coarse, {options.run.threads, {}}) : joined_sources(in, coarse, joined);
        if (!options.seams.empty()) {
            RingMesh seamed(in.positions, in.corners);
            tag_seams(seamed, in, options.seams);
            out.corner_source = corner_sources(in, seamed, coarse, {options.run.threads, {}});
        }
    }
    out.faces = std::move(coarse.vertex);
    return out;
}

/// Vertices of a result in the input's box of diagonal 1.
std::vector<double> boxed(const DecimationInput& in, const std::vector<double>& vertices) {
    std::vector<double> out(vertices.size());
    for (std::size_t i = 0; i < out.size(); i += 3) store(&out[i], 1 / in.diagonal * (load(&vertices[i]) - in.centre));
    return out;
}

/// An upper bound of the two-sided Hausdorff distance over the diagonal; infinite where it is more than `limit`.
/// \param index  of the input's faces.
double proven_error(const DecimationInput& in, const ClosestIndex& index, const Decimation& made, double limit,
                    const Execution& run) {
    if (made.faces.empty()) return std::numeric_limits<double>::infinity();
    const std::vector<double> coarse = boxed(in, made.vertices);
    HausdorffOptions options;
    options.limit = limit;
    options.tolerance = limit / 100;
    options.run.threads = run.threads;
    const double back = hausdorff_bound(coarse, made.faces, index, options).upper;
    if (back > limit) return std::numeric_limits<double>::infinity();
    const double there =
        hausdorff_bound(in.points(), in.corners, ClosestIndex(coarse, made.faces, options.run), options).upper;
    return there > limit ? std::numeric_limits<double>::infinity() : std::max(back, there);
}

/// Bisection of the number of faces, by ratios: the distance falls with it, if not strictly, and what is given back was
/// proven.
Decimation decimate_to_error(const DecimationInput& in, const std::optional<FaceBoxes>& fine, DecimateOptions options) {
    const ClosestIndex index(in.points(), in.corners, {options.run.threads, {}});
    options.faces = in.faces.size();
    const Execution run = options.run;
    options.run.progress = {};
    Decimation best = decimate_to_faces(in, fine, options);
    double enough = static_cast<double>(in.faces.size()), too_few = 1;
    constexpr int trials = 10;
    for (int trial = 0; trial < trials && enough > 1.02 * too_few + 1; ++trial) {
        // The first trials look low: most meshes hold far more faces than an error of interest needs.
        options.faces = static_cast<std::size_t>(std::sqrt(enough * too_few));
        Decimation made = decimate_to_faces(in, fine, options);
        const double bound = proven_error(in, index, made, options.error, run);
        const bool stuck = made.stop == DecimationStop::validity;
        if (bound <= options.error) {
            const std::size_t faces = made.faces.size() / 3;
            enough = static_cast<double>(faces);
            best = std::move(made);
            best.error_bound = bound;
            if (stuck) break;
        } else {
            too_few = static_cast<double>(options.faces);
        }
        if (run.progress && !run.progress((trial + 1.0) / (trials + 1))) throw Cancelled();
    }
    return best;
}

}  // namespace

Decimation decimate(Points vertices, Triangles faces, const DecimateOptions& options) {
    check(vertices, faces, options);
    const DecimationInput in = decimation_input(vertices, faces, options.run);
    Decimation made;
    std::optional<FaceBoxes> fine;
    const auto make_boxes = [&] { fine.emplace(face_boxes(in.positions, in.corners, {options.run.threads, {}})); };
    if (is_fitted(options)) make_boxes();
    if (!in.faces.empty())
        made = options.error > 0 ? decimate_to_error(in, fine, options) : decimate_to_faces(in, fine, options);
    made.degenerate = in.degenerate;
    made.non_finite = in.non_finite;
    Lap watch;
    if (options.measure && !made.faces.empty()) {
        if (!fine) make_boxes();
        const std::vector<double> flat = boxed(in, made.vertices);
        const DecimationError error = decimation_error(in, *fine, flat, made.faces, {options.run.threads, {}});
        made.max_error = error.max, made.rms_error = error.rms;
    }
    watch.add_to(made.seconds_measure);
    return made;
}

}  // namespace gaussmap
