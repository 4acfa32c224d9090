#include "normal_regression.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "normal_fit.h"
#include "shape_tensor.h"
#include "slope_fit.h"

namespace gaussmap {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Standard error of |S|², S the symmetric part: to first order its derivatives by the rows of s are twice the rows of
/// S. The noise of the element's own normal shifts all samples; what noise adds on average comes to it squared.
double standard_error(const Slopes& fit, const Symmetric2& s) {
    if (fit.free == 0) return nan;
    const double noise = fit.residual / (2 * fit.free);
    double covariance[2][2], first = 0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) covariance[i][j] = fit.covariance[i][j] + fit.shift[i] * fit.shift[j];
    const double rows[2][2] = {{2 * s.uu, 2 * s.uv}, {2 * s.uv, 2 * s.vv}};
    for (const auto& row : rows)
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) first += row[i] * covariance[i][j] * row[j];
    const double second = 1.5 * noise * (covariance[0][0] + covariance[1][1]);
    return std::sqrt(noise * first + second * second);
}

SlopeFit collect(const Neighborhood& around, const ElementNormals& normals, const Frame& frame) {
    SlopeFit slopes;
    for (std::size_t j = 0; j < around.count; ++j) {
        Vec3 normal = normals.normal[static_cast<std::size_t>(around.index[j])];
        if (!finite(normal)) continue;
        if (normals.align && dot(normal, frame.n) < 0) normal = -normal;
        const Vec3 d = around.offset(j);
        slopes.add(dot(d, frame.u), dot(d, frame.v), dot(normal, frame.u), dot(normal, frame.v));
    }
    return slopes;
}

}  // namespace

ElementNormals fit_normals(const Elements& elements, int k, CloudNormals method, int degree, const Execution& run) {
    ElementNormals normals;
    normals.align = true;
    normals.normal.resize(elements.count);
    normals.lowered.resize(elements.count);
    const auto stride = static_cast<std::size_t>(k);
    for_blocks(elements.count, Elements::block, run, [&](std::size_t, std::size_t first, std::size_t last) {
        std::vector<std::int32_t> rows((last - first) * stride);
        elements.neighbors(first, last, k, rows.data());
        LaneNeighborhoods around(stride);
        NormalFit fit(method, degree, stride);
        NormalFit::Result results[fit_lanes];
        for (std::size_t i = first; i < last; i += fit_lanes) {
            const std::size_t count = std::min<std::size_t>(fit_lanes, last - i);
            around.gather(elements, i, count, rows.data() + (i - first) * stride, stride);
            fit(around, results);
            for (std::size_t l = 0; l < count; ++l) {
                normals.normal[i + l] = results[l].normal;
                normals.lowered[i + l] = results[l].lowered ? 1 : 0;
            }
        }
    });
    return normals;
}

FittedCurvature normal_regression(const Elements& elements, int k, const ElementNormals& normals, bool error,
                                  const Execution& run) {
    FittedCurvature result;
    result.density.assign(elements.count, nan);
    result.normal = normals.normal;
    result.tensor.resize(elements.count);
    if (error) result.error.assign(elements.count, nan);
    std::vector<std::size_t> lowered_in(block_count(elements.count, Elements::block));
    for_neighborhoods(elements, k, run, [&](std::size_t block) {
        return [&, block](std::size_t i, const Neighborhood& around) {
            if (!finite(normals.normal[i])) return;
            const Frame frame = frame_about(normals.normal[i]);
            const SlopeFit slopes = collect(around, normals, frame);
            Slopes fit;
            const bool quadratic = slopes.count() > 5 && slopes.solve<5>(fit);
            if (!quadratic && (slopes.count() < 2 || !slopes.solve<2>(fit))) return;
            lowered_in[block] += !quadratic || (!normals.lowered.empty() && normals.lowered[i] != 0);
            const double scale = around.scale;
            const Symmetric2 s = {scale * fit.s[0][0], scale * 0.5 * (fit.s[0][1] + fit.s[1][0]), scale * fit.s[1][1]};
            result.tensor[i] = in_plane(frame, s.uu, s.uv, s.vv);
            result.density[i] = s.uu * s.uu + 2 * s.uv * s.uv + s.vv * s.vv;
            if (error) {
                const double down = 1 / scale;
                result.error[i] = scale * scale * standard_error(fit, {down * s.uu, down * s.uv, down * s.vv});
            }
        };
    });
    for (const std::size_t n : lowered_in) result.lowered += n;
    return result;
}

}  // namespace gaussmap
