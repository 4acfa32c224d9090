#include "window_fits.h"

#include <cmath>
#include <limits>

#include "principal_normal.h"

namespace gaussmap {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

void WindowFits::see(int lane, const View& view) {
    found_[lane].frame = frame_about(view.normal);
    views_.see(lane, found_[lane].frame, view.size, view.foot);
}

Vec3 WindowFits::principal(int lane) {
    alone_.clear();
    for (int j = 0; j < range_.last[lane]; ++j) alone_.push_back(neighbor(lane, j));
    return principal_normal(alone_, range_.last[lane]);
}

/// Settle views on quadrics, which noise sways least. `residuals` are what those left before the last turn, infinite
/// where nothing is determined.
void WindowFits::settle_on_quadric(const LaneFitKernel& kernel, int turns, Views& views, Residuals& residuals) {
    bool on[fit_lanes] = {};
    for (int l = 0; l < filled_; ++l) residuals[l] = infinity, on[l] = finite(views[l].normal);
    for (; turns > 0; --turns) {
        for (int l = 0; l < filled_; ++l)
            if (on[l]) see(l, views[l]);
        kernel.quadric.collect(room_.get(), views_, range_, true, sums_);
        kernel.quadric.solve(sums_, AtElement::free, false, fields_);
        for (int l = 0; l < filled_; ++l) {
            on[l] = on[l] && fields_.determined[l];
            if (!on[l]) continue;
            residuals[l] = fields_.residual[l];
            settle(views[l], found_[l].frame, fields_.field(l).c);
            on[l] = finite(views[l].normal);
        }
    }
    for (int l = 0; l < filled_; ++l)
        if (!finite(views[l].normal)) residuals[l] = infinity;
}

/// The known view, or a fresh one, whichever leaves less: at corners of a noisy border a first view may be tilted
/// beyond recovery.
void WindowFits::fit(const Vec3 (&normals)[fit_lanes], bool fresh, const LaneFitKernel& kernel) {
    Views views = {};
    Residuals residuals = {};
    for (int l = 0; l < filled_; ++l) {
        const double size = length(neighbor(l, range_.last[l] - 1));
        views[l] = {size > 0 ? normals[l] : Vec3{NAN, NAN, NAN}, {}, size};
    }
    settle_on_quadric(kernel, 1, views, residuals);
    if (fresh) {
        Views others = {};
        Residuals left = {};
        for (int l = 0; l < filled_; ++l)
            others[l] = {views[l].size > 0 ? principal(l) : Vec3{NAN, NAN, NAN}, {}, views[l].size};
        settle_on_quadric(kernel, 2, others, left);
        for (int l = 0; l < filled_; ++l)
            if (left[l] < residuals[l]) views[l] = others[l], residuals[l] = left[l];
    }
    for (int l = 0; l < filled_; ++l)
        if (std::isfinite(residuals[l])) see(l, views[l]);
    kernel.quartic.collect(room_.get(), views_, range_, true, sums_);
    for (int q = 0; q < 2; ++q) {
        (q == 0 ? kernel.quadric : kernel.quartic).solve(sums_, AtElement::free, true, fields_);
        for (int l = 0; l < filled_; ++l) {
            WindowFit& found = found_[l];
            found.view = views[l];
            found.weight = sums_.at[LaneSums::power][l];
            found.field[q] = fields_.field(l);
            found.determined[q] =
                std::isfinite(residuals[l]) && fields_.determined[l] && (q == 0 || found.determined[0]);
        }
    }
}

}  // namespace gaussmap
