#include "jet_curvature.h"

#include <cmath>
#include <limits>

#include "patch.h"
#include "principal_normal.h"
#include "shape_tensor.h"

namespace gaussmap {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Found {
    SurfaceJet jet;
    double error = nan;
};

/// Standard error of the density of a field through the element, in units of the view's size.
///
/// The heights are differences from the element, whose own noise shifts them all: with r what the fit makes of heights
/// that are 1 everywhere, its second derivatives have the covariance σ² (C + r rᵀ). To that comes the square of what
/// noise adds to the density on average.
template <int Degree>
double standard_error(const HeightField<Degree>& field, const std::vector<Vec3>& offsets, const View& view,
                      const Frame& frame) {
    if (field.free == 0) return nan;
    Moments<Degree> shift;
    HeightField<Degree> r;
    shift.clear();
    const double scale = 1 / view.size;
    for (const Vec3 d : offsets) shift.add(scale * dot(d, frame.u), scale * dot(d, frame.v), 1);
    if (!shift.solve(false, r)) return nan;
    const double along = 8 * (field.c[3] * r.c[3] + field.c[5] * r.c[5]) + 4 * field.c[4] * r.c[4];
    const double noise = field.residual / field.free;
    const double first = noise * (density_variance(field) + along * along);
    const double second =
        noise * (shape_variance(field) + 4 * (r.c[3] * r.c[3] + r.c[5] * r.c[5]) + 2 * r.c[4] * r.c[4]);
    return std::sqrt(first + second * second);
}

/// In the frame of the view, then in that of the fitted normal. False where the neighbours do not determine the degree.
template <int Degree>
bool fit(const std::vector<Vec3>& offsets, View view, bool error, Found& found) {
    Moments<Degree> moments;
    HeightField<Degree> field;
    Frame frame;
    for (int turn = 0; turn < 2; ++turn) {
        if (turn > 0) view.normal = found.jet.normal;
        frame = collect(moments, offsets.data(), static_cast<int>(offsets.size()), false, view, Chart::monge);
        if (!moments.solve(false, field, true)) return false;
        found.jet = surface_jet(field.c, frame, view.size);
    }
    if (error) found.error = standard_error(field, offsets, view, frame) / (view.size * view.size);
    return finite(found.jet.normal);
}

/// The degree that was fitted; 0 for none.
int fit_highest(int degree, const std::vector<Vec3>& offsets, const View& view, bool error, Found& found) {
    if (degree >= 4 && fit<4>(offsets, view, error, found)) return 4;
    if (degree >= 3 && fit<3>(offsets, view, error, found)) return 3;
    return fit<2>(offsets, view, error, found) ? 2 : 0;
}

}  // namespace

FittedCurvature jet_curvature(const Elements& elements, int k, int degree, bool error, const Execution& run) {
    FittedCurvature result;
    result.density.assign(elements.count, nan);
    result.normal.assign(elements.count, {nan, nan, nan});
    result.tensor.resize(elements.count);
    if (error) result.error.assign(elements.count, nan);
    std::vector<std::size_t> lowered_in(block_count(elements.count, Elements::block));
    for_neighborhoods(elements, k, run, [&](std::size_t block) {
        return [&, block, offsets = std::vector<Vec3>()](std::size_t i, const Neighborhood& around) mutable {
            const Vec3 principal = principal_normal(around, false);
            if (around.count == 0 || !finite(principal)) return;
            offsets.clear();
            for (std::size_t j = 0; j < around.count; ++j) offsets.push_back(around.offset(j));
            Found found;
            const int fitted = fit_highest(degree, offsets, {principal, {}, length(offsets.back())}, error, found);
            if (fitted == 0) return;
            lowered_in[block] += fitted < degree;
            result.normal[i] = found.jet.normal;
            add(result.tensor[i], around.scale, found.jet.tensor);
            result.density[i] = squared_norm(result.tensor[i]);
            if (error) result.error[i] = found.error * around.scale * around.scale;
        };
    });
    for (const std::size_t n : lowered_in) result.lowered += n;
    return result;
}

}  // namespace gaussmap
