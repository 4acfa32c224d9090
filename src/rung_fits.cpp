#include "rung_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel.h"
#include "patch.h"
#include "principal_normal.h"
#include "shape_tensor.h"
#include "slope_fit.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 256;

/// Weighted sums in place of counts: the sandwich covariance of a fit with `SmoothingWeights` relative to that of
/// data with variances 1 / weight, and what an unknown takes from the sum of the weights (both for discs; the ratio
/// falls little at borders).
constexpr double sandwich[2] = {0.474, 0.627}, weight_of_unknown[2] = {0.51, 0.467};

/// Settle the view on a quadric, which noise sways least; what it left before the last turn, infinite where nothing is
/// determined.
double settle_on_quadric(Moments<2>& moments, const std::vector<Vec3>& neighbors, int turns, View& view) {
    double residual = std::numeric_limits<double>::infinity();
    for (; turns > 0 && finite(view.normal); --turns) {
        HeightField<2> field;
        const Frame frame = collect(moments, neighbors.data(), static_cast<int>(neighbors.size()), false, view,
                                    Chart::chord, SmoothingWeights());
        if (!moments.solve(true, field)) break;
        residual = field.residual;
        settle(view, frame, field.c);
    }
    return finite(view.normal) ? residual : std::numeric_limits<double>::infinity();
}

}  // namespace

Rung RungFits::step(int rung) {
    Rung found(level_.count());
    constexpr std::size_t part = 64 * grain;  // whose rows are held at once
    for (std::size_t first = 0; first < level_.count(); first += part)
        fit(rung, first, std::min(level_.count(), first + part), found);
    average(found);
    return found;
}

void RungFits::fit(int rung, std::size_t first, std::size_t last, Rung& found) {
    std::vector<std::size_t> who;
    std::vector<double> feet;
    for (std::size_t i = first; i < last; ++i) {
        if (!active_[i]) continue;
        who.push_back(i);
        feet.insert(feet.end(), {level_.foot[3 * i], level_.foot[3 * i + 1], level_.foot[3 * i + 2]});
    }
    if (who.empty()) return;
    const auto k = static_cast<std::size_t>(rung_neighbors(rung) / static_cast<int>(level_.members));
    const bool by_faces = elements_.connected && level_.members == 1;
    std::vector<std::int32_t> rows;
    if (by_faces) {
        rows.assign((last - first) * k, -1);
        for_blocks(last - first, Elements::block, run_, [&](std::size_t, std::size_t a, std::size_t b) {
            elements_.neighbors(first + a, first + b, static_cast<int>(k), rows.data() + a * k);
        });
    } else {
        rows = index_.nearest(Points(feet), static_cast<int>(k), false, run_).index;
    }
    for_blocks(who.size(), grain, run_, [&](std::size_t, std::size_t a, std::size_t b) {
        std::vector<Vec3> neighbors;
        Moments<2> quadric;
        Moments<4> quartic;
        for (; a < b; ++a) {
            const std::size_t i = who[a];
            const std::int32_t* row = rows.data() + (by_faces ? i - first : a) * k;
            const Vec3 foot = level_.foot_of(i);
            neighbors.clear();
            if (by_faces) neighbors.push_back(level_.at(i) - foot);
            for (std::size_t j = 0; j < k && row[j] >= 0; ++j)
                neighbors.push_back(level_.at(static_cast<std::size_t>(row[j])) - foot);
            if (neighbors.size() < k) continue;
            found.half_size[i] = static_cast<float>(length(neighbors[k / 2 - 1]));
            fit_element(i, rung, neighbors, quadric, quartic, found);
            const std::size_t stride = (k + most_samples - 1) / most_samples;
            std::int32_t* to = samples_.data() + i * most_samples;
            for (std::size_t s = 0; s < most_samples; ++s) to[s] = s * stride < k ? row[s * stride] : -1;
        }
    });
}

/// The view from the rung below, or while windows are small a fresh one, whichever leaves less: at corners of a noisy
/// border a first view may be tilted beyond recovery.
void RungFits::fit_element(std::size_t i, int rung, const std::vector<Vec3>& neighbors, Moments<2>& quadric,
                           Moments<4>& quartic, Rung& found) {
    constexpr int rungs_of_fresh_views = 6;
    const int count = static_cast<int>(neighbors.size());
    View view = {level_.normal[i], {}, length(neighbors.back())};
    if (!(view.size > 0)) return;
    double residual = std::numeric_limits<double>::infinity();
    if (rung > 0) residual = settle_on_quadric(quadric, neighbors, 1, view);
    if (rung < rungs_of_fresh_views) {
        View fresh = {principal_normal(neighbors, count), {}, view.size};
        const double left = settle_on_quadric(quadric, neighbors, 2, fresh);
        if (left < residual) view = fresh, residual = left;
    }
    if (!std::isfinite(residual)) return;
    HeightField<2> curved;
    const Frame frame = collect(quartic, neighbors.data(), count, false, view, Chart::chord, SmoothingWeights());
    HeightField<4> full;
    if (!quartic.solve(true, curved, true)) return;
    found.size[i] = static_cast<float>(view.size);
    const double size4 = std::pow(view.size, 4), size6 = std::pow(view.size, 6);
    const auto keep = [&](int q, Family family, const auto& field) {
        const SurfaceJet jet = surface_jet(field.c, frame, view.size);
        const auto f = static_cast<int>(family);
        const double each = sandwich[q] / level_.members;
        const double free = quartic.weight() - weight_of_unknown[q] * (count - field.free);
        found.tensor[f][i] = jet.tensor;
        found.density[f][i] = static_cast<float>(squared_norm(jet.tensor));
        found.variance[q][i] = static_cast<float>(each * density_variance(field) / size6);
        found.trace[q][i] = static_cast<float>(each * shape_variance(field) / size4);
        found.residual[q][i] = static_cast<float>(level_.members * field.residual /
                                                  std::max(free, 0.1 * quartic.weight()) * view.size * view.size);
        return jet;
    };
    const SurfaceJet jet = keep(0, Family::quadric, curved);
    found.normal[i] = jet.normal;
    // A foot that runs away is no foot.
    const Vec3 step = view.foot + view.size * curved.c[0] * frame.n;
    if (squared(step) < 0.25 * view.size * view.size && finite(jet.normal)) {
        store(level_.foot.data() + 3 * i, level_.foot_of(i) + step);
        level_.normal[i] = jet.normal;
    }
    if (quartic.solve(true, full, true)) keep(1, Family::quartic, full);
}

void RungFits::average(Rung& found) {
    for_blocks(level_.count(), grain, run_, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i)
            if (active_[i] && std::isfinite(found.density[static_cast<int>(Family::quadric)][i]))
                average_element(i, found);
    });
}

/// Over the samples within half the neighbours' reach and within all of it, with the weights 1 − (d/h)²: the mean of
/// the quadrics' shape operators, and the slopes of their normals over their feet.
void RungFits::average_element(std::size_t i, Rung& found) {
    const auto& quadric = found.tensor[static_cast<int>(Family::quadric)];
    const Vec3 normal = found.normal[i], foot = level_.foot_of(i);
    const Frame frame = frame_about(normal);
    const double unit = 1 / double(found.size[i]);
    const double reach[2] = {double(found.half_size[i]) * found.half_size[i], double(found.size[i]) * found.size[i]};
    Symmetric3 sum[2] = {quadric[i], quadric[i]};
    double weights[2] = {1, 1};
    SlopeFit slopes[2];
    const std::int32_t* row = samples_.data() + i * most_samples;
    for (int s = 0; s < most_samples && row[s] >= 0; ++s) {
        const auto other = static_cast<std::size_t>(row[s]);
        if (other == i || !std::isfinite(found.size[other])) continue;
        const double along = dot(found.normal[other], normal);
        // Other sheets and far sides look elsewhere.
        if (!(std::abs(along) >= one_sheet)) continue;
        const double sign = along < 0 ? -1 : 1;
        const Vec3 there = sign * found.normal[other], d = level_.foot_of(other) - foot;
        const double away = squared(d);
        if (away >= reach[1]) continue;
        const Symmetric3 tensor = carried(quadric[other], there, normal);
        for (int m = 0; m < 2; ++m) {
            const double weight = 1 - away / reach[m];
            if (!(weight > 0)) continue;
            add(sum[m], sign * weight, tensor), weights[m] += weight;
            slopes[m].add(unit * dot(d, frame.u), unit * dot(d, frame.v), dot(there, frame.u), dot(there, frame.v),
                          weight);
        }
    }
    for (int m = 0; m < 2; ++m) {
        const auto mean = static_cast<int>(m == 0 ? Family::half_mean : Family::mean);
        Symmetric3 tensor;
        add(tensor, 1 / weights[m], sum[m]);
        found.tensor[mean][i] = tensor;
        found.density[mean][i] = static_cast<float>(squared_norm(tensor));
        Slopes fit;
        if (slopes[m].count() < 10 || !slopes[m].solve<5>(fit)) continue;
        const auto slope = static_cast<int>(m == 0 ? Family::half_slope : Family::slope);
        Symmetric3& shape = found.tensor[slope][i];
        add_product(shape, unit * fit.s[0][0], frame.u, frame.u);
        add_product(shape, unit * (fit.s[0][1] + fit.s[1][0]), frame.u, frame.v);
        add_product(shape, unit * fit.s[1][1], frame.v, frame.v);
        found.density[slope][i] = static_cast<float>(squared_norm(shape));
        // Over a disc filled evenly Σ w u² = n h² / 12.
        const double even = 24 / (slopes[m].count() * reach[m] * unit * unit);
        found.spread[m][i] = static_cast<float>(std::max(1.0, (fit.covariance[0][0] + fit.covariance[1][1]) / even));
    }
}

}  // namespace gaussmap
