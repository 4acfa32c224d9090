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
/// Errors of the fits relative to their measured change, at most about: of quartics 0.15 to 0.6, of quadrics 1.
constexpr double error_share[] = {0.5, 0.5, 1};
/// Noise that moves the density by less than this is no matter.
constexpr double negligible = 1e-4;
/// Residuals with less noise than this part are those of a clean surface.
constexpr double noise_part = 0.25;
/// Noise scatters the densities of neighbours; residuals that scatter them less than this part of what noise would
/// (relative variances, at most 1) are those of a shape too thin for its sampling.
constexpr double scatter_part = 0.3;

constexpr int fits = 3;  ///< chord, monge, quadric

/// What the first look found, an element each.
struct Looks {
    std::vector<FirstLook::Fit> fit[fits];
    std::vector<float> change[fits];  ///< squared
    std::vector<float> residual, wide_residual, variance, trace;
    std::vector<float> scatter;   ///< of the logarithm of the density among neighbours
    std::vector<float> expected;  ///< squared relative error that noise would make, at most 1

    explicit Looks(std::size_t count)
        : residual(count, nan),
          wide_residual(residual),
          variance(residual),
          trace(residual),
          scatter(residual),
          expected(residual) {
        for (int f = 0; f < fits; ++f) fit[f].resize(count), change[f] = residual;
    }
};

/// Squared error that the noise told by the residuals makes in an interpolating quartic's density.
double noise_error(const Looks& looks, std::size_t i) {
    const double noise = interpolation_variance * noise_variance(looks.residual[i], looks.wide_residual[i]);
    const double second = noise * looks.trace[i];
    return noise * looks.variance[i] + second * second;
}

void keep(const FirstLook& look, std::size_t i, Looks& looks) {
    const FirstLook::Fit* found[fits] = {&look.chord, &look.monge, &look.quadric};
    for (int f = 0; f < fits; ++f) {
        looks.fit[f][i] = *found[f];
        looks.change[f][i] = static_cast<float>(found[f]->change * found[f]->change);
    }
    looks.residual[i] = static_cast<float>(look.residual);
    looks.wide_residual[i] = static_cast<float>(look.wide_residual);
    looks.variance[i] = static_cast<float>(look.variance);
    looks.trace[i] = static_cast<float>(look.trace);
    looks.scatter[i] = static_cast<float>(std::log(look.chord.density + std::numeric_limits<float>::min()));
}

/// The neighbours of an element, put into a lane; how many there are.
int gather(const Elements& elements, double scale, std::size_t i, const std::int32_t* row, std::size_t lane,
           LanePatches& patches) {
    const Vec3 here = elements.position(i);
    int count = 0;
    for (; count < wide_neighbors && row[count] >= 0; ++count) {
        const Vec3 d = scale * (elements.position(static_cast<std::size_t>(row[count])) - here);
        patches.d[count][0][lane] = d.x, patches.d[count][1][lane] = d.y, patches.d[count][2][lane] = d.z;
    }
    return count;
}

Looks look_around(const Elements& elements, double scale, ElementGraph& graph, AutomaticCurvature& result,
                  const Execution& run) {
    Looks looks(elements.count);
    std::vector<std::size_t> lowered_in(block_count(elements.count, Elements::block));
    for_blocks(elements.count, Elements::block, run, [&](std::size_t block, std::size_t first, std::size_t last) {
        std::vector<std::int32_t> rows((last - first) * wide_neighbors);
        elements.neighbors(first, last, wide_neighbors, rows.data());
        LanePatches patches;
        for (std::size_t i = first; i < last; i += fit_lanes) {
            FirstLook found[fit_lanes];
            int counts[fit_lanes] = {};
            const std::size_t end = std::min(i + fit_lanes, last);
            for (std::size_t j = i; j < end; ++j)
                counts[j - i] = gather(elements, scale, j, rows.data() + (j - first) * wide_neighbors, j - i, patches);
            first_look(patches, counts, found);
            for (std::size_t j = i; j < end; ++j) {
                const FirstLook& look = found[j - i];
                const std::int32_t* row = rows.data() + (j - first) * wide_neighbors;
                std::copy(row, row + ElementGraph::degree,
                          graph.index.begin() + static_cast<std::ptrdiff_t>(j * ElementGraph::degree));
                lowered_in[block] += look.lowered && finite(look.normal);
                result.normal[j] = look.normal;
                result.choice[j] = static_cast<std::uint8_t>(!finite(look.normal) ? 0 : look.lowered ? 1 : 2);
                keep(look, j, looks);
            }
        }
    });
    for (const std::size_t n : lowered_in) result.lowered += n;

    for (auto& change : looks.change) diffuse(change, graph, 8, run);
    for (auto* field : {&looks.residual, &looks.wide_residual}) diffuse(*field, graph, 15, run);
    for (std::size_t i = 0; i < elements.count; ++i) {
        const double density = looks.fit[0][i].density;
        looks.expected[i] = static_cast<float>(std::min(1.0, noise_error(looks, i) / (density * density)));
    }
    looks.scatter = roughness(looks.scatter, graph, run);
    for (auto* field : {&looks.expected, &looks.scatter}) diffuse(*field, graph, 15, run);
    return looks;
}

/// Mix the fits of an element by the inverse fourth powers of their errors nearby.
void mix(const Looks& looks, std::size_t i, AutomaticCurvature& result) {
    double weight[fits], sum = 0, smallest = std::numeric_limits<double>::infinity(), square[fits];
    for (int f = 0; f < fits; ++f) {
        const double change = looks.change[f][i];
        square[f] = std::isfinite(looks.fit[f][i].density) ? error_share[f] * error_share[f] * change : nan;
        if (square[f] < smallest) smallest = square[f];
    }
    double expected = 0;
    for (int f = 0; f < fits; ++f) {
        // Relative to the smallest, so that nothing overflows; where that is 0 it alone counts.
        const double ratio = smallest / square[f];
        weight[f] = square[f] == smallest ? 1 : ratio >= 0 ? ratio * ratio : 0;
        if (weight[f] > 0) sum += weight[f], expected += weight[f] * square[f];
    }
    if (!(sum > 0)) return;
    Symmetric3 mixed;
    for (int f = 0; f < fits; ++f)
        if (weight[f] > 0) add(mixed, weight[f] / sum, looks.fit[f][i].tensor);
    result.tensor[i] = mixed;
    result.density[i] = squared_norm(mixed);
    result.error[i] = std::sqrt(expected / sum);
}

/// Whether noise is most of what the residuals tell, and matters.
bool is_noisy(const Looks& looks, std::size_t i) {
    const double noise = noise_variance(looks.residual[i], looks.wide_residual[i]);
    return noise > noise_part * looks.residual[i] && looks.expected[i] > negligible * negligible &&
           looks.scatter[i] > scatter_part * looks.expected[i];
}

/// Where the ladder is needed.
std::vector<std::uint8_t> settle_looks(const Looks& looks, AutomaticCurvature& result) {
    std::vector<std::uint8_t> noisy(result.density.size(), 0);
    for (std::size_t i = 0; i < noisy.size(); ++i) {
        mix(looks, i, result);
        if (!is_noisy(looks, i)) continue;
        noisy[i] = 1;
        result.error[i] = std::hypot(result.error[i], std::sqrt(noise_error(looks, i)));
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
    result.density.assign(count, std::numeric_limits<double>::quiet_NaN());
    result.error = result.density;
    result.normal.resize(count);
    result.tensor.resize(count);
    result.choice.resize(count);
    ElementGraph graph;
    graph.index.resize(count * ElementGraph::degree);

    std::vector<std::uint8_t> noisy =
        settle_looks(look_around(elements, scale, graph, result, part_of(run, 0, 0.3)), result);
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
