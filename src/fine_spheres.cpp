#include "fine_spheres.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel.h"
#include "rung_fits.h"
#include "shape_tensor.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1024;

constexpr Symmetric3 unknown = {NAN, NAN, NAN, NAN, NAN, NAN};

/// The shape operator of the level set of height 0, which is parallel to the one through the place: S (1 + h S)⁻¹.
Symmetric3 on_surface(const PlacedLevelSet& level_set) {
    constexpr double far = 0.5, folded = 0.3;
    const Symmetric3& s = level_set.shape;
    const double h = level_set.at_place.height;
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

void FineSurface::coarsen(const CoarserLevel& above) {
    for (std::int32_t& over : over_) over = above.parent[static_cast<std::size_t>(over)];
    representative_ = at(representative_, above.representative);
    list_members(above.level.count());
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

void FineSurface::keep(int rung, const Level& level, const std::vector<std::uint8_t>& active, const Rung& found,
                       const Execution& run) {
    Surface& surface = surface_[static_cast<std::size_t>(rung % rungs_below)];
    surface.assign(over_.size(), {});
    for_blocks(over_.size(), grain, run, [&](std::size_t, std::size_t j, std::size_t last) {
        for (; j < last; ++j) {
            const auto i = static_cast<std::size_t>(over_[j]);
            if (!active[i] || !std::isfinite(found.size[i])) continue;
            // The quadric about the foot of the element that stands for this one, beside that foot.
            const Vec3 foot = level.foot_of(i), n = found.normal[i], d = lowest_.foot_of(j) - foot,
                       x = d - dot(d, n) * n;
            const Vec3 turn = product(found.tensor[static_cast<int>(Family::quadric)][i], x);
            store(surface[j].foot, foot + x - 0.5 * dot(x, turn) * n);
            store(surface[j].normal, unit(n + turn));
            surface[j].weight = 1;
        }
    });
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
    std::size_t most = 0;
    for (int l = 0; l < windows.filled; ++l) most = std::max(most, samples[l].size());
    for (int l = 0; l < windows.filled; ++l) samples[l].resize(most, -1), places[l].samples = samples[l].data();
    const auto look = [&](const double(&radius)[fit_lanes], std::size_t count, Symmetric3(&tensor)[fit_lanes]) {
        for (int l = 0; l < windows.filled; ++l) places[l].radius = radius[l];
        PlacedLevelSet found[fit_lanes];
        find_level_sets(surface, places, windows.filled, static_cast<int>(count), Count::all, found);
        for (int l = 0; l < windows.filled; ++l)
            tensor[l] = found[l].found ? carried(in_space(found[l], on_surface(found[l]), radius[l]), found[l].frame.n,
                                                 across[windows.element[l]])
                                       : unknown;
    };
    // Half of a window and a little more: members of the nearest elements come first, and only nearly by distance.
    constexpr double part_of_half = 0.7;
    FineSpheres result;
    Symmetric3 half[fit_lanes];
    look(windows.whole, most, result.whole);
    look(windows.half, static_cast<std::size_t>(std::ceil(part_of_half * static_cast<double>(most))), half);
    for (int l = 0; l < windows.filled; ++l) {
        result.extrapolated[l] = {};
        // Twice the area makes twice the bias, where it is of the lowest order.
        add(result.extrapolated[l], 2, half[l]);
        add(result.extrapolated[l], -1, result.whole[l]);
    }
    return result;
}

}  // namespace gaussmap
