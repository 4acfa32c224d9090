#include "rung_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel.h"
#include "shape_tensor.h"
#include "slope_fit.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 256;

/// Weighted sums in place of counts: the sandwich covariance of a fit with smoothing weights relative to that of
/// data with variances 1 / weight, and what an unknown takes from the sum of the weights (both for discs; the ratio
/// falls little at borders).
constexpr double sandwich[2] = {0.474, 0.627}, weight_of_unknown[2] = {0.51, 0.467};

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
        WindowFits windows(static_cast<int>(k) + 1);
        std::size_t in_lane[fit_lanes];
        for (; a < b; ++a) {
            const std::size_t i = who[a];
            const std::int32_t* row = rows.data() + (by_faces ? i - first : a) * k;
            const Vec3 foot = level_.foot_of(i);
            if (by_faces) windows.add(level_.at(i) - foot);
            for (std::size_t j = 0; j < k && row[j] >= 0; ++j)
                windows.add(level_.at(static_cast<std::size_t>(row[j])) - foot);
            if (windows.count() < static_cast<int>(k)) {
                windows.drop();
                continue;
            }
            found.half_size[i] = static_cast<float>(length(windows.neighbor(static_cast<int>(k) / 2 - 1)));
            const std::size_t stride = (k + most_samples - 1) / most_samples;
            std::int32_t* to = samples_.data() + i * most_samples;
            for (std::size_t s = 0; s < most_samples; ++s) to[s] = s * stride < k ? row[s * stride] : -1;
            in_lane[windows.filled()] = i;
            windows.close();
            if (windows.full()) fit_windows(in_lane, rung, windows, found);
        }
        fit_windows(in_lane, rung, windows, found);
    });
}

/// In the views from the rung below, and while windows are small in fresh ones too.
void RungFits::fit_windows(const std::size_t (&who)[fit_lanes], int rung, WindowFits& windows, Rung& found) {
    constexpr int rungs_of_fresh_views = 6;
    Vec3 normals[fit_lanes];
    for (int l = 0; l < windows.filled(); ++l) normals[l] = rung > 0 ? level_.normal[who[l]] : Vec3{NAN, NAN, NAN};
    windows.fit(normals, rung < rungs_of_fresh_views);
    for (int l = 0; l < windows.filled(); ++l)
        if (windows[l].determined[0]) keep(who[l], windows[l], found);
    windows.clear();
}

void RungFits::keep(std::size_t i, const WindowFit& fit, Rung& found) {
    const double size = fit.view.size, size4 = std::pow(size, 4), size6 = std::pow(size, 6);
    found.size[i] = static_cast<float>(size);
    for (int q = 0; q < 2; ++q) {
        if (!fit.determined[q]) continue;
        const HeightField<2>& field = fit.field[q];
        const SurfaceJet jet = surface_jet(field.c, fit.frame, size);
        const auto f = static_cast<int>(q == 0 ? Family::quadric : Family::quartic);
        const double each = sandwich[q] / level_.members;
        const double free = fit.weight - weight_of_unknown[q] * WindowFit::unknowns[q];
        found.tensor[f][i] = jet.tensor;
        found.density[f][i] = static_cast<float>(squared_norm(jet.tensor));
        found.variance[q][i] = static_cast<float>(each * density_variance(field) / size6);
        found.trace[q][i] = static_cast<float>(each * shape_variance(field) / size4);
        found.residual[q][i] =
            static_cast<float>(level_.members * field.residual / std::max(free, 0.1 * fit.weight) * size * size);
        if (q == 1) continue;
        found.normal[i] = jet.normal;
        // A foot that runs away is no foot.
        const Vec3 step = fit.view.foot + size * field.c[0] * fit.frame.n;
        if (squared(step) < 0.25 * size * size && finite(jet.normal)) {
            store(level_.foot.data() + 3 * i, level_.foot_of(i) + step);
            level_.normal[i] = jet.normal;
        }
    }
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
