// First a look at every element by interpolating quartics, which is all that a clean surface needs; then, where their
// residuals tell of noise that matters, the ladder of scales.
#include "automatic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "element_graph.h"
#include "first_look.h"
#include "parallel.h"
#include "scale_ladder.h"

namespace gaussmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Variance of an interpolating quartic's density relative to that of equal weights.
constexpr double interpolation_variance = 8;
/// Errors of interpolating quartics relative to what equal weights change: measured, 0.15 to 0.6.
constexpr double remainder_share = 0.5;
/// Noise that moves the density by less than this is no matter.
constexpr double negligible = 1e-4;
/// Residuals with less noise than this part are those of a clean surface.
constexpr double noise_part = 0.25;

/// What the choice between the charts and the noise are told by, an element each.
struct Signs {
    std::vector<float> chord_change, monge_change;  ///< squared
    std::vector<float> residual, wide_residual;
    std::vector<float> variance, trace;
    explicit Signs(std::size_t count)
        : chord_change(count, nan),
          monge_change(chord_change),
          residual(chord_change),
          wide_residual(chord_change),
          variance(chord_change),
          trace(chord_change) {}
};

void look_around(const Elements& elements, double scale, ElementGraph& graph, AutomaticCurvature& result,
                 std::vector<Symmetric3>& monge, Signs& signs, const Execution& run) {
    const std::size_t blocks = block_count(elements.count, Elements::block);
    std::vector<std::size_t> lowered_in(blocks);
    for_blocks(elements.count, Elements::block, run, [&](std::size_t block, std::size_t first, std::size_t last) {
        std::vector<std::int32_t> rows((last - first) * wide_neighbors);
        elements.neighbors(first, last, wide_neighbors, rows.data());
        std::vector<Vec3> neighbors(wide_neighbors);
        for (std::size_t i = first; i < last; ++i) {
            const std::int32_t* row = rows.data() + (i - first) * wide_neighbors;
            std::copy(row, row + ElementGraph::degree,
                      graph.index.begin() + static_cast<std::ptrdiff_t>(i * ElementGraph::degree));
            const Vec3 here = elements.position(i);
            int count = 0;
            for (; count < wide_neighbors && row[count] >= 0; ++count)
                neighbors[count] = scale * (elements.position(static_cast<std::size_t>(row[count])) - here);
            const FirstLook look = first_look(neighbors, count);
            lowered_in[block] += look.lowered && finite(look.normal);
            result.normal[i] = look.normal;
            result.tensor[i] = look.chord;
            monge[i] = look.monge;
            result.density[i] = look.chord_density;
            signs.chord_change[i] = static_cast<float>(look.chord_change * look.chord_change);
            signs.monge_change[i] = static_cast<float>(look.monge_change * look.monge_change);
            signs.residual[i] = static_cast<float>(look.residual);
            signs.wide_residual[i] = static_cast<float>(look.wide_residual);
            signs.variance[i] = static_cast<float>(look.variance);
            signs.trace[i] = static_cast<float>(look.trace);
            result.choice[i] = static_cast<std::uint8_t>(!finite(look.normal) ? 0 : look.lowered ? 1 : 2);
        }
    });
    for (const std::size_t n : lowered_in) result.lowered += n;
}

/// Blend the two charts by the inverse fourth powers of what equal weights change in them nearby, and tell where the
/// ladder is needed.
std::vector<std::uint8_t> blend(const std::vector<Symmetric3>& monge_tensor, const Signs& signs,
                                AutomaticCurvature& result) {
    const std::size_t count = result.density.size();
    std::vector<std::uint8_t> noisy(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const double chord = signs.chord_change[i], monge = signs.monge_change[i];
        if (!std::isfinite(result.density[i])) continue;
        if (result.choice[i] != 2 || !std::isfinite(chord) || !std::isfinite(monge)) {
            result.error[i] = result.density[i];
            continue;
        }
        const double sum = chord * chord + monge * monge;
        const double share = sum > 0 ? monge * monge / sum : 0.5;
        const double change = share * chord + (1 - share) * monge;
        Symmetric3 mixed;
        add(mixed, share, result.tensor[i]);
        add(mixed, 1 - share, monge_tensor[i]);
        result.tensor[i] = mixed;
        result.density[i] = squared_norm(mixed);

        const double noise = noise_variance(signs.residual[i], signs.wide_residual[i]);
        const double second = interpolation_variance * noise * signs.trace[i];
        const double variance = interpolation_variance * noise * signs.variance[i] + second * second;
        const double remainder = remainder_share * remainder_share * change;
        result.error[i] = std::sqrt(remainder + variance);
        const double least = negligible * result.density[i];
        noisy[i] = noise > noise_part * signs.residual[i] && variance > least * least ? 1 : 0;
    }
    return noisy;
}

}  // namespace

AutomaticCurvature automatic_curvature(const Elements& elements, double size, const Execution& run) {
    const std::size_t count = elements.count;
    // Lengths of about one edge: squares of squares of densities stay far from the ends of the exponents.
    const double edge = size / std::sqrt(static_cast<double>(std::max<std::size_t>(count, 1)));
    const double scale = std::ldexp(1.0, -std::ilogb(edge));
    AutomaticCurvature result;
    result.density.resize(count);
    result.error.assign(count, std::numeric_limits<double>::quiet_NaN());
    result.normal.resize(count);
    result.tensor.resize(count);
    result.choice.resize(count);
    ElementGraph graph;
    graph.index.resize(count * ElementGraph::degree);

    Signs signs(count);
    std::vector<std::uint8_t> noisy;
    {
        std::vector<Symmetric3> monge(count);  // the looks in Monge coordinates, until they are blended
        look_around(elements, scale, graph, result, monge, signs, part_of(run, 0, 0.3));
        for (auto* field : {&signs.chord_change, &signs.monge_change}) diffuse(*field, graph, 8, run);
        for (auto* field : {&signs.residual, &signs.wide_residual, &signs.variance, &signs.trace})
            diffuse(*field, graph, 15, run);
        noisy = blend(monge, signs, result);
    }
    climb(elements, scale, graph, std::move(noisy), result, part_of(run, 0.3, 1));
    if (run.progress && !run.progress(1)) throw Cancelled();

    const double scale2 = scale * scale;
    result.graph = std::move(graph);
    result.unit = 1 / scale2;
    for (std::size_t i = 0; i < count; ++i) {
        result.density[i] *= scale2;
        result.error[i] *= scale2;
        Symmetric3 unscaled;
        add(unscaled, scale, result.tensor[i]);
        result.tensor[i] = unscaled;
    }
    return result;
}

}  // namespace gaussmap
