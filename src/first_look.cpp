#include "first_look.h"

#include <algorithm>
#include <cmath>

#include "eigen3.h"
#include "patch.h"

namespace gaussmap {

Vec3 principal_normal(const std::vector<Vec3>& neighbors, int count) {
    Vec3 mean;
    for (int j = 0; j < count; ++j) mean = mean + neighbors[j];
    mean = 1.0 / (count + 1) * mean;
    Symmetric3 m;
    add_product(m, 1, mean, mean);
    for (int j = 0; j < count; ++j) add_product(m, 1, neighbors[j] - mean, neighbors[j] - mean);
    const Eigen3 principal = eigen(m);
    // On a line there is no plane.
    if (!(principal.values[1] > 1e-13 * principal.values[2])) return {FirstLook::nan, FirstLook::nan, FirstLook::nan};
    return upward(principal.vectors[0]);
}

namespace {

/// Turn the view until a quadric through the element over its nearest neighbours has no slope there.
bool level(Moments<2>& moments, const std::vector<Vec3>& neighbors, int count, View& view, SurfaceJet& jet) {
    HeightField<2> field;
    for (int turn = 0; turn < 2; ++turn) {
        const Frame frame = collect(moments, neighbors.data(), count, false, view, Chart::chord);
        if (!moments.solve(false, field)) return false;
        jet = surface_jet(field.c, frame, view.size);
        view.normal = jet.normal;
    }
    return finite(view.normal);
}

double density_of(const HeightField<4>& field, const Frame& frame, const View& view) {
    return squared_norm(surface_jet(field.c, frame, view.size).tensor);
}

/// Residual variance of a quartic free to pass by the element.
bool free_quartic(Moments<4>& moments, const View& view, HeightField<4>& field, double& residual) {
    if (!moments.solve(true, field, true) || field.free < 1) return false;
    residual = field.residual / field.free * view.size * view.size;
    return true;
}

}  // namespace

FirstLook first_look(const std::vector<Vec3>& neighbors, int count) {
    constexpr int nearest = 9;  // enough for a quadric, and the unit of lengths
    FirstLook look;
    if (count < 3) return look;
    const int few = std::min(count, nearest);
    View view = {principal_normal(neighbors, std::min(count, 12)), {}, length(neighbors[few - 1])};
    if (!(view.size > 0)) return look;

    Moments<2> quadric;
    SurfaceJet jet;
    look.lowered = true;
    // The nearest may lie on a conic, as of one or two lines of a scan; further ones then tell more.
    if (count < 5) return look;
    if (!finite(view.normal) || !level(quadric, neighbors, few, view, jet)) {
        view = {principal_normal(neighbors, count), {}, length(neighbors[static_cast<std::size_t>(count) - 1])};
        if (!finite(view.normal) || !level(quadric, neighbors, count, view, jet)) return look;
    }
    look.normal = jet.normal;
    const Vec3 quadric_normal = jet.normal;
    // Nothing tells the remainder of a quadric alone: take it for as large as the value.
    look.quadric = {jet.tensor, squared_norm(jet.tensor), squared_norm(jet.tensor)};

    int look_count = std::min(count, look_neighbors);
    Moments<4> quartic;
    HeightField<4> field;
    for (int turn = 0; turn < 2; ++turn) {
        const Frame frame =
            collect(quartic, neighbors.data(), look_count, false, view, Chart::chord, RemainderWeights());
        if (!quartic.solve(false, field)) {
            // On the border of a grid the nearest lie on four lines, too few for a quartic, and more on five.
            if (turn > 0 || look_count == count) return look;
            look_count = count;
            --turn;
            continue;
        }
        jet = surface_jet(field.c, frame, view.size);
        if (turn == 0) view.normal = jet.normal;
    }
    HeightField<4> weighted_monge, equal, equal_monge;
    const Frame frame = collect(quartic, neighbors.data(), look_count, false, view, Chart::monge, RemainderWeights());
    if (!quartic.solve(false, weighted_monge)) return look;
    const SurfaceJet monge = surface_jet(weighted_monge.c, frame, view.size);
    collect(quartic, neighbors.data(), look_count, true, view, Chart::monge);
    if (!quartic.solve(true, equal_monge)) return look;
    double residual, wide;
    collect(quartic, neighbors.data(), look_count, true, view, Chart::chord);
    if (!free_quartic(quartic, view, equal, residual)) return look;
    HeightField<4> wider;
    collect_more(quartic, neighbors.data() + look_count, std::min(count, wide_neighbors) - look_count, view,
                 Chart::chord);
    if (!free_quartic(quartic, view, wider, wide)) return look;

    look.lowered = false;
    look.normal = jet.normal;
    const double chord = squared_norm(jet.tensor), flat = squared_norm(monge.tensor);
    look.chord = {jet.tensor, chord, chord - density_of(equal, frame, view)};
    look.monge = {carried(monge.tensor, monge.normal, jet.normal), flat, flat - density_of(equal_monge, frame, view)};
    // Unoriented normals of one surface differ by less than a right angle, or there is no telling.
    const Vec3 other = dot(quadric_normal, jet.normal) < 0 ? -quadric_normal : quadric_normal;
    if (dot(quadric_normal, jet.normal) < 0) look.quadric.tensor = negated(look.quadric.tensor);
    look.quadric.tensor = carried(look.quadric.tensor, other, jet.normal);
    look.quadric.change = look.quadric.density - chord;
    look.variance = density_variance(equal) / std::pow(view.size, 6);
    look.trace = shape_variance(equal) / std::pow(view.size, 4);
    if (look_count < count) look.residual = residual, look.wide_residual = wide;
    return look;
}

}  // namespace gaussmap
