#include "fine_spheres.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "rung_fits.h"
#include "shape_tensor.h"

namespace gaussmap {
namespace {

constexpr Symmetric3 unknown = {NAN, NAN, NAN, NAN, NAN, NAN};

/// The shape operator of the level set of height 0, which is parallel to the one through the place: S (1 + h S)⁻¹.
Symmetric3 on_surface(const LevelSet& level_set) {
    constexpr double far = 0.5, folded = 0.3;
    constexpr Vec3 up = {0, 0, 1};
    const Symmetric3 s = carried(level_set.tensor, level_set.normal, up);
    const double h = level_set.height;
    const double stretch = (1 + h * s.xx) * (1 + h * s.yy) - h * h * s.xy * s.xy;
    if (!(std::abs(h) < far) || !(stretch > folded)) return unknown;
    const double determinant = s.xx * s.yy - s.xy * s.xy;
    return {(s.xx + h * determinant) / stretch, s.xy / stretch, 0, (s.yy + h * determinant) / stretch, 0, 0};
}

}  // namespace

FineSurface::FineSurface(const Level& lowest)
    : lowest_(lowest), over_(lowest.count()), representative_(lowest.count()) {
    std::iota(over_.begin(), over_.end(), 0);
    representative_ = over_;
    list_members(lowest.count());
}

void FineSurface::coarsen(const Level& below, const Level& above) {
    for (std::int32_t& over : over_) over = below.parent[static_cast<std::size_t>(over)];
    representative_ = at(representative_, above.representative);
    list_members(above.count());
}

void FineSurface::list_members(std::size_t elements) {
    first_member_.assign(elements + 1, 0);
    for (const std::int32_t over : over_) ++first_member_[static_cast<std::size_t>(over) + 1];
    std::partial_sum(first_member_.begin(), first_member_.end(), first_member_.begin());
    member_.resize(over_.size());
    std::vector<std::int32_t> next = first_member_;
    for (std::size_t j = 0; j < over_.size(); ++j)
        member_[static_cast<std::size_t>(next[static_cast<std::size_t>(over_[j])]++)] = static_cast<std::int32_t>(j);
}

void FineSurface::keep(int rung, const Level& level, const std::vector<std::uint8_t>& active, const Rung& found) {
    Surface& surface = surface_[static_cast<std::size_t>(rung % rungs_below)];
    surface.assign(over_.size(), {});
    for (std::size_t j = 0; j < over_.size(); ++j) {
        const auto i = static_cast<std::size_t>(over_[j]);
        if (!active[i] || !std::isfinite(found.size[i])) continue;
        // The quadric about the foot of the element that stands for this one, beside that foot.
        const Vec3 foot = level.foot_of(i), n = found.normal[i], d = lowest_.foot_of(j) - foot, x = d - dot(d, n) * n;
        const Vec3 turn = product(found.tensor[static_cast<int>(Family::quadric)][i], x);
        store(surface[j].foot, foot + x - 0.5 * dot(x, turn) * n);
        store(surface[j].normal, unit(n + turn));
        surface[j].weight = 1;
    }
}

const Surface& FineSurface::for_rung(int rung) const {
    return surface_[static_cast<std::size_t>(rung % rungs_below)];
}

FineSpheres fine_spheres(const FineSurface& fine, const Surface& surface, const FineWindows& windows,
                         std::size_t length, const std::vector<Vec3>& across) {
    std::vector<std::int32_t> samples[fit_lanes];
    SphereWindow places[fit_lanes];
    for (int l = 0; l < windows.filled; ++l) {
        const std::size_t own = fine.representative(windows.element[l]);
        const auto take = [&](std::size_t element) {
            for (const std::int32_t* member = fine.begin(element); member != fine.end(element); ++member)
                if (static_cast<std::size_t>(*member) != own) samples[l].push_back(*member);
        };
        take(windows.element[l]);
        for (std::size_t j = 0; j < length; ++j)
            if (windows.row[l][j] >= 0) take(static_cast<std::size_t>(windows.row[l][j]));
        places[l].place = &surface[own];
    }
    const auto look = [&](const double(&radius)[fit_lanes], double part, Symmetric3(&tensor)[fit_lanes]) {
        std::size_t most = 0;
        for (int l = 0; l < windows.filled; ++l) most = std::max(most, samples[l].size());
        for (int l = 0; l < windows.filled; ++l) samples[l].resize(most, -1);
        for (int l = 0; l < windows.filled; ++l) places[l].samples = samples[l].data(), places[l].radius = radius[l];
        PlacedLevelSet found[fit_lanes];
        const auto count = static_cast<int>(std::ceil(part * static_cast<double>(most)));
        find_level_sets(surface, places, windows.filled, count, Count::all, found);
        for (int l = 0; l < windows.filled; ++l) {
            tensor[l] = unknown;
            if (!found[l].found) continue;
            const Symmetric3 s = on_surface(found[l].at_place);
            const double u = 1 / radius[l];
            tensor[l] = carried(in_plane(found[l].frame, u * s.xx, u * s.xy, u * s.yy), found[l].frame.n,
                                across[windows.element[l]]);
        }
    };
    FineSpheres result;
    Symmetric3 half[fit_lanes];
    // Half of a window and a little more, as members of the nearest elements come first.
    look(windows.whole, 1, result.whole);
    look(windows.half, 0.7, half);
    for (int l = 0; l < windows.filled; ++l) {
        result.extrapolated[l] = {};
        // Twice the area makes twice the bias, where it is of the lowest order.
        add(result.extrapolated[l], 2, half[l]);
        add(result.extrapolated[l], -1, result.whole[l]);
    }
    return result;
}

}  // namespace gaussmap
