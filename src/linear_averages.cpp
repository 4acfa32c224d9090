// Windows of fifty elements and more find densities that vary little within ten, but for the noise of each element's
// own foot and choice. An average over those alone would take away what is linear, too, as neighbours lie unevenly
// about an element, most of all beside borders; so it is the value of a linear fit, P D. Of what bends 1 − (1 − P²)³,
// twicing done twice, takes away hardly anything (Stuetzle and Mittal, "Some comments on the asymptotic behavior of
// robust smoothers", 1979). Where noise moves points along the surface by as much as neighbours are apart, a density is
// one of somewhere about there, and 1 − (1 − P³)² is nearer to it.
#include "linear_averages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "element_graph.h"
#include "frame.h"
#include "parallel.h"
#include "scale_ladder.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1024;
constexpr double same_side = 0.5;  ///< least cosine of normals of one sheet
constexpr double ridge = 1e-3;     ///< of the mean second moment, for neighbours on a line
/// Beside an edge, whose densities may be a thousand times larger, averages overshoot.
constexpr double most_changed = 2;
constexpr float left_of_noise = 0.85F;

struct Weights {
    std::array<float, ElementGraph::degree + 1> of = {1};  ///< what the element and each of its neighbours count
    float moved = 0;  ///< noise relative to the variance of the neighbours' places along an axis, up to 1
};

Weights weights_of(const Level& level, const Measured& measured, float noise, std::size_t i) {
    Weights weights;
    const Frame frame = frame_about(measured.normal[i]);
    if (!finite(frame.u)) return weights;
    std::array<double, ElementGraph::degree> x, y;
    std::array<bool, ElementGraph::degree> counts = {};
    double sum = 1, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (std::size_t j = 0; j < ElementGraph::degree && level.graph[i][j] >= 0; ++j) {
        const auto other = static_cast<std::size_t>(level.graph[i][j]);
        counts[j] =
            std::isfinite(measured.density[other]) && std::abs(dot(measured.normal[other], frame.n)) > same_side;
        if (!counts[j]) continue;
        const Vec3 d = level.at(other) - level.at(i);
        x[j] = dot(d, frame.u), y[j] = dot(d, frame.v);
        sum += 1, sx += x[j], sy += y[j];
        sxx += x[j] * x[j], sxy += x[j] * y[j], syy += y[j] * y[j];
    }
    if (noise > 0) weights.moved = std::min(1.0F, noise / static_cast<float>(0.5 * (sxx + syy) / (sum - 1)));
    const double more = ridge * 0.5 * (sxx + syy);
    sxx += more, syy += more;
    const double determinant = sxx * syy - sxy * sxy;
    if (!(determinant > 0)) return weights;
    const double a = (syy * sx - sxy * sy) / determinant, b = (sxx * sy - sxy * sx) / determinant;
    const double all = sum - a * sx - b * sy;  // at least 1, what the element itself counts
    weights.of[0] = static_cast<float>(1 / all);
    for (std::size_t j = 0; j < ElementGraph::degree; ++j)
        if (counts[j]) weights.of[j + 1] = static_cast<float>((1 - a * x[j] - b * y[j]) / all);
    return weights;
}

}  // namespace

void smooth_densities(const Level& lowest, const std::vector<float>& noise, Measured& measured, const Execution& run) {
    const std::size_t count = lowest.count();
    std::vector<Weights> weights(count);
    for_blocks(count, grain, run, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) weights[i] = weights_of(lowest, measured, noise[i], i);
    });
    const auto average = [&](const std::vector<double>& field, std::vector<double>& mean) {
        for_blocks(count, grain, run, [&](std::size_t, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                mean[i] = static_cast<double>(weights[i].of[0]) * field[i];
                for (std::size_t j = 0; j < ElementGraph::degree; ++j)
                    if (weights[i].of[j + 1] != 0)
                        mean[i] += static_cast<double>(weights[i].of[j + 1]) *
                                   field[static_cast<std::size_t>(lowest.graph[i][j])];
            }
        });
    };
    // What P, P², … P⁶ of the densities count: of 1 − (1 − P²)³ and of 1 − (1 − P³)².
    constexpr double still[] = {0, 3, 0, -3, 0, 1}, moved[] = {0, 0, 2, 0, 0, -1};
    std::vector<double> field = measured.density, next(count), smooth(count, 0);
    for (int power = 0; power < 6; ++power) {
        average(field, next);
        std::swap(field, next);
        for (std::size_t i = 0; i < count; ++i) {
            const double part = weights[i].moved;
            smooth[i] += ((1 - part) * still[power] + part * moved[power]) * field[i];
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double density = measured.density[i];
        if (measured.choice[i] < first_rung_choice || !std::isfinite(density)) continue;
        const double value = std::clamp(smooth[i], density / most_changed, density * most_changed);
        measured.density[i] = value;
        measured.error[i] -= (1 - left_of_noise) * measured.noise[i];
        measured.noise[i] *= left_of_noise;
        measured.tensor[i] = scaled(density > 0 ? std::sqrt(value / density) : 1, measured.tensor[i]);
    }
}

}  // namespace gaussmap
