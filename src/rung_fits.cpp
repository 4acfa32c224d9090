#include "rung_fits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "instruction_sets.h"
#include "parallel.h"
#include "shape_tensor.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 256;

/// The last rung on the lowest level of a mesh. Rings are searched for its 216 neighbours at once: nearly every element
/// gets there, and a search for fewer would have to be made again.
constexpr int last_by_rings = 6;

LaneAverageKernel* best_lane_averages() {
    return GAUSSMAP_FASTEST(lane_averages);
}
/// Call body(who, filled) with the elements that are known, a lane each.
template <class Known, class Body>
void for_lanes(std::size_t count, Known&& known, const Execution& run, Body&& body) {
    for_blocks(count, grain, run, [&](std::size_t, std::size_t i, std::size_t last) {
        std::size_t who[fit_lanes];
        int filled = 0;
        for (; i < last; ++i) {
            if (known(i)) who[filled++] = i;
            if (filled == fit_lanes || (filled > 0 && i + 1 == last)) body(who, std::exchange(filled, 0));
        }
    });
}

/// Weighted sums in place of counts: the sandwich covariance of a fit with smoothing weights relative to that of
/// data with variances 1 / weight, and what an unknown takes from the sum of the weights (both for discs; the ratio
/// falls little at borders).
constexpr double sandwich[2] = {0.474, 0.627}, weight_of_unknown[2] = {0.51, 0.467};

}  // namespace

Rung RungFits::step(int rung) {
    Rung found(level_.count());
    constexpr std::size_t part = 64 * grain;  // whose rows are held at once
    if (by_rings() && rings_.empty()) keep_rings();
    for (std::size_t first = 0; first < level_.count(); first += part)
        fit(rung, first, std::min(level_.count(), first + part), found);
    average(rung, found);
    return found;
}

std::size_t RungFits::ring_width() const {
    return window(last_by_rings);
}

void RungFits::keep_rings() {
    const std::size_t width = ring_width();
    rings_.assign(level_.count() * width, -1);
    for_blocks(level_.count(), Elements::block, run_, [&](std::size_t, std::size_t a, std::size_t b) {
        const auto on = [&](std::size_t i) { return active_[i] != 0; };
        for (std::size_t end = a; a < b; a = end) {
            for (end = a + 1; end < b && on(end) == on(a);) ++end;
            if (on(a)) elements_.neighbors(a, end, static_cast<int>(width), rings_.data() + a * width);
        }
    });
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
    const std::size_t k = window(rung);
    const bool along_edges = by_rings();
    const std::size_t width = along_edges ? ring_width() : std::min(reach(k), level_.count());
    const std::size_t stride = fine_ ? 1 : averaged_stride(k), seen = fine_ ? width : k;
    std::vector<std::int32_t> rows;
    if (!along_edges) rows = index_.nearest(Points(feet), static_cast<int>(width), false, run_).index;
    for_blocks(who.size(), grain, run_, [&](std::size_t, std::size_t a, std::size_t b) {
        WindowFits windows(static_cast<int>(k) + 1);
        std::size_t in_lane[fit_lanes];
        for (; a < b; ++a) {
            const std::size_t i = who[a];
            const std::int32_t* row = along_edges ? rings_.data() + i * width : rows.data() + a * width;
            const Vec3 foot = level_.foot_of(i);
            if (along_edges) windows.add(level_.at(i) - foot);
            for (std::size_t j = 0; j < k && row[j] >= 0; ++j)
                windows.add(level_.at(static_cast<std::size_t>(row[j])) - foot);
            if (windows.count() < static_cast<int>(k)) {
                windows.drop();
                continue;
            }
            found.half_size[i] = static_cast<float>(length(windows.neighbor(static_cast<int>(k) / 2 - 1)));
            std::int32_t* to = samples_.data() + i * most_samples_;
            for (std::size_t j = 0; j < seen; j += stride) *to++ = row[j] != static_cast<std::int32_t>(i) ? row[j] : -1;
            in_lane[windows.filled()] = i;
            windows.close();
            if (windows.full()) fit_windows(in_lane, rung, windows, found);
        }
        if (windows.filled() > 0) fit_windows(in_lane, rung, windows, found);
    });
}

/// In the views from the rung below, and while windows are small in fresh ones too.
void RungFits::fit_windows(const std::size_t (&who)[fit_lanes], int rung, WindowFits& windows, Rung& found) {
    // The rings of a mesh lie around the vertex even where noise is as thick as the spacing.
    const int rungs_of_fresh_views = elements_.connected ? 3 : 6;
    Vec3 normals[fit_lanes];
    for (int l = 0; l < windows.filled(); ++l) normals[l] = rung > 0 ? level_.normal[who[l]] : Vec3{NAN, NAN, NAN};
    windows.fit(normals, rung < rungs_of_fresh_views);
    for (int l = 0; l < windows.filled(); ++l)
        if (windows[l].determined[0]) keep(who[l], windows[l], found);
    windows.clear();
}

void RungFits::keep(std::size_t i, const WindowFit& fit, Rung& found) {
    const double size = fit.view.size, size2 = size * size, size4 = size2 * size2;
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
        found.variance[q][i] = static_cast<float>(each * density_variance(field) / (size2 * size4));
        found.trace[q][i] = static_cast<float>(each * shape_variance(field) / size4);
        found.residual[q][i] =
            static_cast<float>(level_.members * field.residual / std::max(free, 0.1 * fit.weight) * size2);
        if (q == 1) continue;
        found.normal[i] = jet.normal;
        // A foot that runs away is no foot.
        const Vec3 step = fit.view.foot + size * field.c[0] * fit.frame.n;
        if (squared(step) < 0.25 * size2 && finite(jet.normal)) {
            store(level_.foot.data() + 3 * i, level_.foot_of(i) + step);
            level_.normal[i] = jet.normal;
        }
    }
}

void RungFits::average(int rung, Rung& found) {
    const std::size_t k = window(rung), stride = averaged_stride(k), count = (k + stride - 1) / stride;
    const auto& quadric = found.tensor[static_cast<int>(Family::quadric)];
    std::vector<SurfaceSample> samples(level_.count());
    const auto known = [&](std::size_t i) { return active_[i] && std::isfinite(found.size[i]); };
    for_blocks(level_.count(), grain, run_, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) {
            if (!known(i)) continue;
            const Vec3 normal = found.normal[i];
            const Symmetric3& t = quadric[i];
            samples[i] = {{normal.x, normal.y, normal.z},
                          {level_.foot[3 * i], level_.foot[3 * i + 1], level_.foot[3 * i + 2]},
                          {t.xx, t.xy, t.xz, t.yy, t.yz, t.zz},
                          double(level_.area[i])};
        }
    });
    const auto averaged = [&](std::size_t i) { return known(i) && averages_wanted(i); };
    for_lanes(level_.count(), averaged, run_, [&](const std::size_t(&who)[fit_lanes], int filled) {
        average_elements(who, filled, static_cast<int>(count), fine_ ? static_cast<int>(stride) : 1, samples, found);
    });
    if (!fine_) return;
    keep_spheres(static_cast<int>(k), found);
    if (rung >= FineSurface::rungs_below) keep_fine_spheres(rung, found);
    fine_->keep(rung, level_, active_, found, run_);
}

/// Quadrics ask for what the slopes tell of borders.
bool RungFits::averages_wanted(std::size_t i) const {
    constexpr Family asking[] = {Family::quadric, Family::half_mean, Family::mean, Family::half_slope, Family::slope};
    return std::any_of(std::begin(asking), std::end(asking),
                       [&](Family family) { return dead_[static_cast<std::size_t>(family)][i] == 0; });
}

/// Over the samples within half the neighbours' reach and within all of it.
void RungFits::average_elements(const std::size_t (&who)[fit_lanes], int filled, int count, int stride,
                                const std::vector<SurfaceSample>& samples, Rung& found) {
    LaneCentres centres;
    centres.count = count;
    centres.stride = stride;
    for (int l = 0; l < filled; ++l) {
        const std::size_t i = who[l];
        const double half = double(found.half_size[i]), whole = double(found.size[i]);
        centres.set(l, frame_about(found.normal[i]), level_.foot_of(i));
        centres.unit[l] = 1 / whole;
        centres.reach[0][l] = half * half, centres.reach[1][l] = whole * whole;
        centres.samples[l] = samples_.data() + i * most_samples_;
    }
    LaneAverages windows[2];
    best_lane_averages()(samples.data(), centres, windows);
    for (int l = 0; l < filled; ++l) keep(who[l], l, samples[who[l]].weight, windows, centres, found);
}

/// The level sets of spheres through the places of a surface, over the windows of the rung.
/// \param keep  called with an element and its level set.
template <class Keep>
void RungFits::find_level_sets(int count, const Surface& surface, const Rung& found, Keep&& keep) const {
    const auto known = [&](std::size_t i) { return surface[i].weight > 0; };
    for_lanes(level_.count(), known, run_, [&](const std::size_t(&who)[fit_lanes], int filled) {
        SphereWindow windows[fit_lanes];
        for (int l = 0; l < filled; ++l) {
            const std::size_t i = who[l];
            windows[l] = {&surface[i], samples_.data() + i * most_samples_, double(found.size[i])};
        }
        PlacedLevelSet level_sets[fit_lanes];
        gaussmap::find_level_sets(surface, windows, filled, count, Count::of_one_half, level_sets);
        for (int l = 0; l < filled; ++l)
            if (level_sets[l].found) keep(who[l], level_sets[l]);
    });
}

/// Of the spheres of the surface that the spheres of the quadrics' surface make: of least noise for their bias. Beside
/// borders, where the first are one-sided, the quadrics' surface stays.
void RungFits::keep_spheres(int count, Rung& found) const {
    constexpr double one_sided = 0.2;  // 0.29 at the border of a half disc
    constexpr double far = 0.5;        // for a surface through the window
    constexpr auto family = static_cast<int>(Family::sphere);
    Surface quadrics(level_.count());
    for (std::size_t i = 0; i < level_.count(); ++i) {
        if (!active_[i] || !std::isfinite(found.size[i])) continue;
        store(quadrics[i].normal, found.normal[i]);
        store(quadrics[i].foot, level_.foot_of(i));
        quadrics[i].weight = double(level_.area[i]);
    }
    Surface spheres = quadrics;
    find_level_sets(count, quadrics, found, [&](std::size_t i, const PlacedLevelSet& level_set) {
        const LevelSet& first = level_set.at_place;
        if (std::hypot(level_set.middle.x, level_set.middle.y) > one_sided || std::abs(first.height) > far) return;
        const Frame& frame = level_set.frame;
        const Vec3 n = first.normal, normal = n.x * frame.u + n.y * frame.v + n.z * frame.n;
        const double height = double(found.size[i]) * first.height;
        store(spheres[i].normal, normal);
        store(spheres[i].foot, load(quadrics[i].foot) + height * normal);
    });
    find_level_sets(count, spheres, found, [&](std::size_t i, const PlacedLevelSet& level_set) {
        const Symmetric3 tensor = in_space(level_set, level_set.shape, double(found.size[i]));
        found.tensor[family][i] = carried(tensor, level_set.frame.n, found.normal[i]);
        found.density[family][i] = static_cast<float>(squared_norm(tensor));
    });
}

void RungFits::keep_fine_spheres(int rung, Rung& found) const {
    constexpr auto fine = static_cast<std::size_t>(Family::fine_sphere),
                   extrapolated = static_cast<std::size_t>(Family::extrapolated);
    const Surface& surface = fine_->for_rung(rung);
    const auto known = [&](std::size_t i) {
        return active_[i] && std::isfinite(found.size[i]) && surface[fine_->representative(i)].weight > 0;
    };
    const std::size_t length = std::min(reach(window(rung)), level_.count());
    for_lanes(level_.count(), known, run_, [&](const std::size_t(&who)[fit_lanes], int filled) {
        FineWindows windows;
        windows.filled = filled;
        for (int l = 0; l < filled; ++l) {
            const std::size_t i = who[l];
            windows.element[l] = i, windows.row[l] = samples_.data() + i * most_samples_;
            windows.half[l] = double(found.half_size[i]), windows.whole[l] = double(found.size[i]);
        }
        const FineSpheres spheres = fine_spheres(*fine_, surface, windows, length, found.normal);
        for (int l = 0; l < filled; ++l) {
            const std::size_t i = who[l];
            found.tensor[fine][i] = spheres.whole[l], found.tensor[extrapolated][i] = spheres.extrapolated[l];
            found.density[fine][i] = static_cast<float>(squared_norm(spheres.whole[l]));
            found.density[extrapolated][i] = static_cast<float>(squared_norm(spheres.extrapolated[l]));
        }
    });
}

/// The mean of the quadrics' shape operators, the element's own among them, and the slopes of their normals over their
/// feet.
void RungFits::keep(std::size_t i, int lane, double own, const LaneAverages (&windows)[2], const LaneCentres& centres,
                    Rung& found) {
    const Frame frame = frame_about(found.normal[i]);
    const double unit = centres.unit[lane];
    for (int m = 0; m < 2; ++m) {
        const LaneAverages& window = windows[m];
        const auto mean = static_cast<int>(m == 0 ? Family::half_mean : Family::mean);
        const double share = 1 / (own + window.weight[lane]);
        Symmetric3 tensor;
        add(tensor, own * share, found.tensor[static_cast<int>(Family::quadric)][i]);
        add(tensor, share, in_plane(frame, window.tensor[0][lane], window.tensor[1][lane], window.tensor[2][lane]));
        found.tensor[mean][i] = tensor;
        found.density[mean][i] = static_cast<float>(squared_norm(tensor));
        const SlopeFit slopes = window.slopes(lane, own);
        Slopes fit;
        if (slopes.count() < 10 || !slopes.solve<5>(fit)) continue;
        const auto slope = static_cast<int>(m == 0 ? Family::half_slope : Family::slope);
        const Symmetric3 shape =
            in_plane(frame, unit * fit.s[0][0], unit * (0.5 * (fit.s[0][1] + fit.s[1][0])), unit * fit.s[1][1]);
        found.tensor[slope][i] = shape;
        found.density[slope][i] = static_cast<float>(squared_norm(shape));
        // Over a disc filled evenly Σ w u² = n h² / 12.
        const double even = 24 / (slopes.count() * centres.reach[m][lane] * unit * unit);
        found.spread[m][i] = static_cast<float>(std::max(1.0, (fit.covariance[0][0] + fit.covariance[1][1]) / even));
    }
}

}  // namespace gaussmap
