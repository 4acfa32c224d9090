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
/// Error of a quartic relative to its change by half as many neighbours more (1.7 to 2.8 on what we measured). Where a
/// window is too wide for its shape both may agree on what is wrong, which equal weights then change all the more. So a
/// part of that change counts too (the error is 0.1 to 0.5 of it): a larger one on grids, whose symmetry hides some of
/// the remainder from the former, and a still larger one where there are no more neighbours.
constexpr double of_widened = 2.2, of_change = 0.05, of_change_on_grid = 0.15, of_change_alone = 0.45;
/// Error of a quadric relative to its difference from the quartic.
constexpr double of_quadric = 0.9;
/// Noise that moves the density by less than this is no matter.
constexpr double negligible = 1e-4;
/// Residuals with less noise than this part are those of a clean surface; with less than the greater part, where that
/// noise would move the density by less than 0.3 %. (Where there is noise alone it is 0.95 and more.)
constexpr double noise_part = 0.25, weak = 0.003, noise_part_where_weak = 0.9;
/// Noise scatters the densities of neighbours; residuals that scatter them less than this part of what noise would
/// (relative variances, at most 1) are those of a shape too thin for its sampling, and where they scatter so many times
/// more there is detail that noise hardly touches.
constexpr double scatter_part = 0.3, detail_part = 20;
/// Noise in which densities of quartics drown makes those of quadrics scatter as well (variance of logarithms, at least
/// 0.4); on tubes that are just sampled well enough quadrics, not quartics, are sure (at most 0.008).
constexpr double drowned = 0.9, drowned_scatter = 0.1;
/// Noise scatters the residuals themselves, too; less than this (variance of logarithms, at least 0.04 under noise)
/// comes of a grid, whose remainders are alike from one point to the next, and grow slowly beside a border.
constexpr double random_scatter = 0.02;

/// Steps of diffusion.
constexpr int error_reach = 2, noise_reach = 15;

constexpr int quartics = 2, fits = 3;  ///< chord, monge; quadric

/// What the first look found, an element each.
struct Looks {
    std::vector<FirstLook::Fit> fit[fits];
    std::vector<float> change[fits], widened[fits];  ///< squared
    std::vector<float> error[fits];                  ///< squared, told by them
    std::vector<float> residual, wide_residual, variance, trace;
    std::vector<float> scatter;           ///< of the logarithm of the density among neighbours
    std::vector<float> quadric_scatter;   ///< the same of the quadric, found where quartics drown
    std::vector<float> residual_scatter;  ///< and of that of the residual
    std::vector<float> expected;          ///< squared relative error that noise would make, at most 1

    explicit Looks(std::size_t count)
        : residual(count, nan),
          wide_residual(residual),
          variance(residual),
          trace(residual),
          scatter(residual),
          quadric_scatter(residual),
          residual_scatter(residual),
          expected(residual) {
        for (int f = 0; f < fits; ++f) fit[f].resize(count), change[f] = widened[f] = error[f] = residual;
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
        looks.widened[f][i] = static_cast<float>(found[f]->widened * found[f]->widened);
    }
    looks.residual[i] = static_cast<float>(look.residual);
    looks.wide_residual[i] = static_cast<float>(look.wide_residual);
    looks.variance[i] = static_cast<float>(look.variance);
    looks.trace[i] = static_cast<float>(look.trace);
    const auto logarithm = [](double value) {
        return static_cast<float>(std::log(value + std::numeric_limits<float>::min()));
    };
    looks.scatter[i] = logarithm(look.chord.density);
    looks.quadric_scatter[i] = logarithm(look.quadric.density);
    looks.residual_scatter[i] = logarithm(look.residual);
}

/// Whether the remainders are alike from one element to the next.
bool on_grid(const Looks& looks, std::size_t i) {
    return looks.residual_scatter[i] < random_scatter;
}

/// What the changes tell of the squared errors, over the surface near by.
void tell_errors(Looks& looks, const ElementGraph& graph, const Execution& run) {
    for (std::size_t i = 0; i < looks.residual.size(); ++i) {
        const double part = on_grid(looks, i) ? of_change_on_grid : of_change;
        for (int f = 0; f < quartics; ++f) {
            const double change = looks.change[f][i], widened = looks.widened[f][i];
            looks.error[f][i] =
                static_cast<float>(std::isfinite(widened) ? of_widened * of_widened * widened + part * part * change
                                                          : of_change_alone * of_change_alone * change);
        }
        looks.error[quartics][i] = static_cast<float>(of_quadric * of_quadric * looks.change[quartics][i]);
    }
    diffuse({&looks.error[0], &looks.error[1], &looks.error[2]}, graph, error_reach, run);
}

/// How logarithms scatter among neighbours, in their place: by their deviations from the neighbours' mean, so that the
/// slope and bend of what is smooth do not pass for noise.
void scatter_of(std::vector<float>& logarithms, const ElementGraph& graph, const Execution& run) {
    std::vector<float> smooth = logarithms;
    diffuse(smooth, graph, 1, run);
    for (std::size_t i = 0; i < logarithms.size(); ++i) logarithms[i] -= smooth[i];
    logarithms = roughness(logarithms, graph, run);
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

/// Some elements in a row, looked at by themselves.
struct Tile {
    std::size_t first, count;

    /// An element's nearest in the tile, numbered from its first one.
    void connect(std::size_t i, const std::int32_t* row, ElementGraph& graph) const {
        std::int32_t* to = graph.index.data() + (i - first) * ElementGraph::degree;
        for (std::size_t j = 0; j < ElementGraph::degree && row[j] >= 0; ++j) {
            const auto other = static_cast<std::size_t>(row[j]);
            if (other >= first && other - first < count) *to++ = static_cast<std::int32_t>(other - first);
        }
        // The rest stays −1.
    }
};

/// Look at the elements of a block, in fours.
void look_at_block(const Elements& elements, const Tile& tile, double scale, std::size_t first, std::size_t last,
                   AutomaticCurvature& result, Looks& looks, std::size_t& lowered) {
    std::vector<std::int32_t> rows((last - first) * wide_neighbors);
    elements.neighbors(first, last, wide_neighbors, rows.data());
    LanePatches patches;
    for (std::size_t i = first; i < last; i += fit_lanes) {
        FirstLook found[fit_lanes];
        int counts[fit_lanes] = {};
        const std::size_t end = std::min(i + fit_lanes, last);
        const auto row = [&](std::size_t j) { return rows.data() + (j - first) * wide_neighbors; };
        for (std::size_t j = i; j < end; ++j) counts[j - i] = gather(elements, scale, j, row(j), j - i, patches);
        first_look(patches, counts, found);
        for (std::size_t j = i; j < end; ++j) {
            const FirstLook& look = found[j - i];
            const std::size_t to = j - tile.first;
            tile.connect(j, row(j), result.graph);
            lowered += look.lowered && finite(look.normal);
            result.normal[to] = look.normal;
            result.choice[to] = static_cast<std::uint8_t>(!finite(look.normal) ? 0 : look.lowered ? 1 : look_choice);
            keep(look, to, looks);
        }
    }
}

/// \param result  of the tile's elements alone, and its graph too.
Looks look_around(const Elements& elements, const Tile& tile, double scale, AutomaticCurvature& result,
                  const Execution& run) {
    Looks looks(tile.count);
    std::vector<std::size_t> lowered(block_count(tile.count, Elements::block));
    for_blocks(tile.count, Elements::block, run, [&](std::size_t block, std::size_t first, std::size_t last) {
        look_at_block(elements, tile, scale, tile.first + first, tile.first + last, result, looks, lowered[block]);
    });
    for (const std::size_t n : lowered) result.lowered += n;

    const ElementGraph& graph = result.graph;
    scatter_of(looks.scatter, graph, run);
    scatter_of(looks.residual_scatter, graph, run);
    diffuse({&looks.residual, &looks.wide_residual, &looks.scatter, &looks.residual_scatter}, graph, noise_reach, run);
    for (std::size_t i = 0; i < tile.count; ++i) {
        const double density = looks.fit[0][i].density;
        looks.expected[i] = static_cast<float>(std::min(1.0, noise_error(looks, i) / (density * density)));
    }
    diffuse(looks.expected, graph, noise_reach, run);
    // Only where quartics are expected to drown are quadrics asked.
    if (std::any_of(looks.expected.begin(), looks.expected.end(), [](float part) { return part >= drowned; })) {
        scatter_of(looks.quadric_scatter, graph, run);
        diffuse(looks.quadric_scatter, graph, noise_reach, run);
    }
    tell_errors(looks, graph, run);
    return looks;
}

/// Mix the fits of an element by the inverse fourth powers of their errors nearby.
void mix(const Looks& looks, std::size_t i, AutomaticCurvature& result) {
    double weight[fits], sum = 0, smallest = std::numeric_limits<double>::infinity(), square[fits];
    for (int f = 0; f < fits; ++f) {
        square[f] = std::isfinite(looks.fit[f][i].density) ? looks.error[f][i] : nan;
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
    const double part = looks.expected[i] < weak * weak ? noise_part_where_weak : noise_part;
    return noise > part * looks.residual[i] && looks.expected[i] > negligible * negligible &&
           looks.scatter[i] > scatter_part * looks.expected[i] && looks.scatter[i] < detail_part * looks.expected[i] &&
           (looks.expected[i] < drowned || looks.quadric_scatter[i] > drowned_scatter) && !on_grid(looks, i);
}

/// Where the ladder is needed.
std::vector<std::uint8_t> settle_looks(const Looks& looks, AutomaticCurvature& result) {
    std::vector<std::uint8_t> noisy(result.density.size(), 0);
    for (std::size_t i = 0; i < noisy.size(); ++i) {
        mix(looks, i, result);
        result.on_grid[i] = on_grid(looks, i);
        if (!is_noisy(looks, i)) continue;
        noisy[i] = 1;
        result.error[i] = std::hypot(result.error[i], std::sqrt(noise_error(looks, i)));
    }
    return noisy;
}

/// What the first look finds in a tile, with lengths scaled; `noisy` where the ladder is needed.
AutomaticCurvature looked_at(const Elements& elements, const Tile& tile, double scale, std::vector<std::uint8_t>& noisy,
                             const Execution& run) {
    AutomaticCurvature result;
    result.density.assign(tile.count, std::numeric_limits<double>::quiet_NaN());
    result.error = result.density;
    result.normal.resize(tile.count);
    result.tensor.resize(tile.count);
    result.choice.resize(tile.count);
    result.on_grid.resize(tile.count);
    result.graph.index.assign(tile.count * ElementGraph::degree, -1);
    noisy = settle_looks(look_around(elements, tile, scale, result, run), result);
    return result;
}

/// To the elements' unit of length.
void unscale(double scale, AutomaticCurvature& result) {
    const double scale2 = scale * scale;
    result.unit = 1 / scale2;
    for (std::size_t i = 0; i < result.density.size(); ++i) {
        result.density[i] *= scale2;
        result.error[i] *= scale2;
        result.tensor[i] = scaled(scale, result.tensor[i]);
    }
}

/// What to scale lengths by, a power of two, so that they are of about one edge: squares of squares of densities stay
/// far from the ends of the exponents.
double scale_of(std::size_t count, double size) {
    const double edge = size / std::sqrt(static_cast<double>(std::max<std::size_t>(count, 1)));
    return std::ldexp(1.0, -std::ilogb(edge));
}

}  // namespace

AutomaticCurvature automatic_curvature(const Elements& elements, double size, const Execution& run) {
    const double scale = scale_of(elements.count, size);
    std::vector<std::uint8_t> noisy;
    AutomaticCurvature result = looked_at(elements, {0, elements.count}, scale, noisy, part_of(run, 0, 0.3));
    climb(elements, scale, result.graph, std::move(noisy), result, part_of(run, 0.3, 1));
    if (run.progress && !run.progress(1)) throw Cancelled();
    unscale(scale, result);
    return result;
}

AutomaticCurvature first_looks(const Elements& elements, std::size_t first, std::size_t count, double size,
                               const Execution& run) {
    const double scale = scale_of(elements.count, size);
    std::vector<std::uint8_t> noisy;
    AutomaticCurvature result = looked_at(elements, {first, count}, scale, noisy, run);
    for (std::size_t i = 0; i < count; ++i)
        if (noisy[i]) result.choice[i] = 0;
    unscale(scale, result);
    return result;
}

std::size_t automatic_curvature(const Elements& elements, double size, const TakeMeasured& take, const Execution& run) {
    constexpr std::size_t most = 65536;
    static_assert(most % Elements::block == 0);
    const double scale = scale_of(elements.count, size);
    const auto fraction = [&](std::size_t i) { return static_cast<double>(i) / static_cast<double>(elements.count); };
    std::size_t lowered = 0, first = 0;
    while (elements.count > most && first < elements.count) {
        const Tile tile = {first, std::min(most, elements.count - first)};
        std::vector<std::uint8_t> noisy;
        AutomaticCurvature found =
            looked_at(elements, tile, scale, noisy, part_of(run, fraction(first), fraction(first + tile.count)));
        if (std::find(noisy.begin(), noisy.end(), 1) != noisy.end()) break;
        unscale(scale, found);
        for (std::size_t i = 0; i < tile.count; ++i) take(found, i, first + i);
        lowered += found.lowered;
        first += tile.count;
    }
    if (first == elements.count) return lowered;
    const AutomaticCurvature found = automatic_curvature(elements, size, part_of(run, fraction(first), 1));
    for (std::size_t i = 0; i < elements.count; ++i) take(found, i, i);
    return found.lowered;
}

}  // namespace gaussmap
