// Each rung fits 1.44 times as many neighbours as the one below, about the foot that the one below found, since a ball
// about a noisy point holds more of its own side. Wide windows stand on the elements of a coarser level. The error of a
// fit is its variance, known from the noise, and its bias, told by what the next rung changes beyond the two fits'
// noise; both averaged over the surface near the element, without which the choice would follow the noise. Averaged
// with its sign, that change also tells what to take off the fit. Comparable: Lepski's rule, 1990, and the refined
// residual squares criterion of Fan and Gijbels, 1995, which choose a bandwidth from such changes.
#include "scale_ladder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "far_side.h"
#include "first_look.h"
#include "linear_averages.h"
#include "parallel.h"
#include "pyramid.h"
#include "rung_fits.h"
#include "shape_tensor.h"
#include "sphere_errors.h"
#include "window_bias.h"

namespace gaussmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float never = std::numeric_limits<float>::infinity();

constexpr int rungs_of_level = 3;  ///< the lowest level has four more, as what is handed down is a little worse
constexpr int level_of(int rung) {
    return std::max(0, (rung - 1) / rungs_of_level - 1);
}

/// What is known of each family, for discs filled evenly.
struct Traits {
    double variance;  ///< relative to the fit's
    double change;    ///< variance of the change to the next rung, relative to the family's own
    /// How much of the bias the next rung adds to it: at most the growth of h² less 1, 0.44, or of h⁴ less 1, 1.07 (of
    /// quartics); windows of noisy data are as wide as the shape, and their bias grows more slowly.
    double bias;
    /// The same at borders, where the bias of quadrics and means grows with h, as odd orders do not cancel over half
    /// discs: at most the growth of h less 1, 0.2, and a little more where even ones are as large.
    double bias_at_border;
    /// Growth of the bias that is told of, relative to the growth that a choice reckons with. That of operators
    /// averaged where windows are as wide as the shape slows down. Level sets of spheres are exact on spheres and
    /// nearly so along circles; their bias sets in late, and then more than doubles from rung to rung: told is what
    /// slower growth would mean. Those of fine samples keep to a part of that. That of wide slopes and of quartics is
    /// less than the changes let fear: so is the error of what was chosen, and the bias of quartics is told by their
    /// windows.
    double told;
    /// Residuals, relative to the noise, of its quadrics or quartics up to which a surface was met alone.
    double fitting;
    /// What the families of second order smooth away alike, where windows are as wide as the shape, no change between
    /// their rungs tells. So this part of its risk counts against those of others, in windows of about a thousand
    /// neighbours and more.
    double share_where_wide;
};
constexpr std::array<Traits, families> traits = {{{1, 0.42, 0.38, 0.23, 0.75, 2, 1},
                                                  {0.27, 0.31, 0.38, 0.23, 0.75, 2, 1},
                                                  {0.09, 0.35, 0.36, 0.22, 0.75, 2, 1},
                                                  {0.23, 0.30, 0.36, 0.36, 1.2, 2, 1},
                                                  {0.10, 0.28, 0.32, 0.32, 1.6, 2, 1},
                                                  {1, 0.50, 0.78, 0.78, 3, 2, 0.5},
                                                  {0.45, 0.33, 1, 1, 0.31, 2.5, 1},
                                                  {2.5, 0.35, 0.6, 0.6, 0.5, 2.5, 0.75},
                                                  {29, 0.36, 1.4, 1.4, 1, 2.5, 1}}};

constexpr bool of_fine_spheres(int family) {
    return family == static_cast<int>(Family::fine_sphere) || family == static_cast<int>(Family::extrapolated);
}

constexpr bool of_spheres(int family) {
    return of_spheres(static_cast<Family>(family));
}

/// Elements of the lowest level lie as they come. That moves level sets of spheres where the surface is none, by a part
/// of what their shape operator has beside its mean: variance of |S|².
double uneven_variance(const Symmetric3& shape, int family, int samples) {
    const double part = of_fine_spheres(family) ? 0.03 : 0.1;
    const double density = squared_norm(shape), sum = shape.xx + shape.yy + shape.zz;
    return part * 4 * density * std::max(0.0, density - 0.5 * sum * sum) / samples;
}

/// Which of a rung's two fits tells of a family: the quadric, which all but quartics stand on, or the quartic.
constexpr std::size_t fit_of(int family) {
    return family == static_cast<int>(Family::quartic) ? 1 : 0;
}

/// Variance of a family's value relative to the fit's.
double relative_variance(const Rung& rung, int family, std::size_t i) {
    const double even = traits[static_cast<std::size_t>(family)].variance;  // of spheres, at borders too
    if (family == static_cast<int>(Family::half_slope)) return even * rung.spread[0][i];
    if (family == static_cast<int>(Family::slope)) return even * rung.spread[1][i];
    return even;
}

/// How much the next rung adds to a family's bias. A border that cuts a window shows in the variance of its slopes.
double bias_growth(const Rung& rung, int family, std::size_t i) {
    constexpr double uncut = 1.3, cut = 2.5;
    const Traits& known = traits[static_cast<std::size_t>(family)];
    const double spread = rung.spread[1][i];
    const double border = spread > uncut ? std::min(1.0, (spread - uncut) / (cut - uncut)) : 0;
    return known.bias + border * (known.bias_at_border - known.bias);
}

/// What the ladder knows of the elements of a level.
struct Standing {
    std::vector<std::uint8_t> active, settled;
    Field noise;  ///< variance of the heights on the lowest level
    FamilyFlags dead;
    std::array<Field, families> least;  ///< squared error of each family's best
    std::array<Field, families> bias;   ///< squared, as far as it is sure on the rungs below
    std::array<Field, families> below;  ///< bias of the rung below, told by the change from it; of spheres

    explicit Standing(std::vector<std::uint8_t> begin)
        : active(std::move(begin)), settled(active.size(), 0), noise(active.size(), nan) {
        dead.fill(settled), least.fill(Field(active.size(), never)), bias.fill(Field(active.size(), 0));
        for (int f = 0; f < families; ++f)
            if (of_spheres(f)) below[f].assign(active.size(), nan);
    }
};

Standing coarsened(const Standing& below, const CoarserLevel& above) {
    Standing standing(at(below.active, above.representative));
    standing.settled = at(below.settled, above.representative);
    standing.noise = at(below.noise, above.representative);
    for (int f = 0; f < families; ++f) {
        standing.dead[f] = at(below.dead[f], above.representative);
        standing.least[f] = at(below.least[f], above.representative);
        standing.bias[f] = at(below.bias[f], above.representative);
        if (of_spheres(f)) standing.below[f] = at(below.below[f], above.representative);
    }
    for (std::size_t i = 0; i < below.active.size(); ++i) {
        if (!below.active[i]) continue;
        const auto parent = static_cast<std::size_t>(above.parent[i]);
        standing.active[parent] = 1;
        for (int f = 0; f < families; ++f) standing.dead[f][parent] &= below.dead[f][i];
    }
    return standing;
}

/// What the next rung changes, by family.
struct Changes {
    std::array<Field, families> variance;  ///< of the density, by noise
    std::array<Field, families> square;    ///< squared changes relative to those expected of noise, over a wide region
    std::array<Field, families> near;      ///< the same near by
    std::array<Field, families> drift;     ///< changes of the density, on average near by
    std::array<Field, families> around;    ///< mean of the neighbours' densities
    Field saddle;                          ///< k1 k2 / (k1² + k2²) of fine spheres, on average near by
};

/// Steps of diffusion. Noise of a part of an edge is chosen for by windows that are small for the shape, so that a wide
/// region is no longer alike.
constexpr int wide_reach = 60, wide_reach_on_meshes = 20, reach_of_variances = 15;

/// One level's part of the climb.
class Ladder {
  public:
    Ladder(const Elements& elements, const Level& level, Standing& standing, Measured& measured, const Execution& run)
        : level_(level),
          tried_(families_tried(elements)),
          wide_reach_(elements.connected ? wide_reach_on_meshes : wide_reach),
          standing_(standing),
          measured_(measured),
          run_{run.threads, {}},
          feared_(spheres_tried(elements) ? level.count() : 0, nan) {}

    /// Weigh the finds of a rung by what the next one changes.
    void weigh(int rung, const Rung& lower, const Rung& upper);
    void let_go();

  private:
    void estimate_noise(int rung, const Rung& lower);
    Changes find_changes(int rung, const Rung& lower, const Rung& upper);
    void weigh_family(int rung, int family, const Rung& lower, const Rung& upper, const Changes& changes);
    bool misfits(int family, float residual, float size, float density, bool hole, std::size_t i) const;

    float least_of_all(std::size_t i) const {
        float least = never;
        for (int family = 0; family < tried_; ++family) least = std::min(least, standing_.least[family][i]);
        return least;
    }

    const Level& level_;
    const int tried_, wide_reach_;
    Standing& standing_;
    Measured& measured_;
    Execution run_;
    std::array<Field, 2> residual_, wider_;  ///< of the lower and the upper rung, averaged nearby
    Field feared_;                           ///< `feared` of fine spheres on the rung below
};

/// Small windows cut the noise off with their ball, and tell too little; from h > 6.5 σ on it is told, at
/// borders, where windows are half discs, not on the first rungs. Until then it may grow from rung to rung by as much
/// as less is cut off, and not by what a shape flattened under a wide window leaves.
void Ladder::estimate_noise(int rung, const Rung& lower) {
    const Field &residual = residual_[1], &wider = wider_[1];
    constexpr int first_to_tell = 3;
    constexpr float less_cut_off = 1.15F;
    for (std::size_t i = 0; i < level_.count(); ++i) {
        if (standing_.settled[i] || !std::isfinite(residual[i]) || !std::isfinite(wider[i])) continue;
        const auto told = static_cast<float>(noise_variance(residual[i], wider[i]));
        const bool known = rung > first_to_tell && std::isfinite(standing_.noise[i]);
        standing_.noise[i] = known ? std::min(told, less_cut_off * standing_.noise[i]) : told;
        standing_.settled[i] = rung >= first_to_tell && lower.size[i] * lower.size[i] > 42 * residual[i];
    }
}

/// Squared changes relative to those expected of noise: what is usual over a wide region and near by, what is surely
/// more than noise, and the most that counts, as the tails of noise are heavy.
constexpr float usual = 1.2F, usual_near = 2, sure = 2.5F, sure_near = 4, most_surprising = 50;
/// A choice had better fear that all of the change over a wide region is bias, and near by what exceeds this.
constexpr float not_feared_near = 1;
constexpr double members_where_wide = Level::group * Level::group;
/// Spheres bear the misfit of the quadric that tells where they stand until the far side is met. Not on the lowest
/// level, where what misfits is detail that its few points show; and those that do not stand on windows of a third only
/// up to this multiple of the noise, as wide windows hold low waves.
constexpr float most_borne = 4;
/// A window that has met the far side tells little of one that has not: of its bias no more than the window below, and
/// of its squared error this part. At holes, where fine spheres bear it, nothing: what is feared is what was below.
constexpr float telling_of_too_wide = 0.4F;
/// Squared differences from the neighbours' mean relative to the expected squared error beyond which a value is false.
constexpr double outlying = 9;

/// Risks, relative to another, that are too large to count beside it.
constexpr float far_above = 3;

/// What an estimate counts, by the inverse fourth power of its risk; infinite risks count nothing.
double weight_of(float risk) {
    return std::pow(static_cast<double>(risk), -4);
}

/// The density of a family, less what noise adds to it.
double unbiased(const Rung& on, int family, const Field& noise, std::size_t i) {
    return on.density[family][i] - noise[i] * relative_variance(on, family, i) * on.trace[fit_of(family)][i];
}

/// What a family errs by on a rung: the next one adds `growth` times that, and changes the density near by so on
/// average. As much of that counts as noise does not make of it, whose variance in a single change is `expected`.
double signed_bias(double drift, double expected, double growth) {
    constexpr double left_on_average = 0.5;  // of that variance: windows of neighbours share most of their noise
    if (!std::isfinite(drift)) return 0;
    const double square = drift * drift, sum = square + left_on_average * expected;
    return sum > 0 ? drift / growth * square / sum : 0;
}

/// All families together, as averages over the surface nearby take less time so.
Changes Ladder::find_changes(int rung, const Rung& lower, const Rung& upper) {
    const std::size_t count = level_.count();
    const Field& noise = standing_.noise;
    Changes changes;
    std::vector<Field*> variances, squares, near_by, densities;
    for (int family = 0; family < tried_; ++family) {
        const std::size_t q = fit_of(family);
        Field& variance = changes.variance[family];
        variance.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            // The square of what noise adds to the density is of second order, and counts where it is not small.
            const double part = noise[i] * relative_variance(lower, family, i), second = part * lower.trace[q][i];
            variance[i] = static_cast<float>(part * lower.variance[q][i] + second * second);
            if (of_fine_spheres(family) || (family == static_cast<int>(Family::sphere) && level_.members == 1))
                variance[i] +=
                    static_cast<float>(uneven_variance(lower.tensor[family][i], family, rung_neighbors(rung)));
        }
        changes.around[family] = lower.density[family];
        variances.push_back(&variance), squares.push_back(&changes.square[family]);
        densities.push_back(&changes.around[family]);
    }
    diffuse(variances, level_.graph, reach_of_variances, run_);
    for (int family = 0; family < tried_; ++family) {
        const double known = traits[static_cast<std::size_t>(family)].change;
        changes.square[family].resize(count), changes.drift[family].resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double change = unbiased(upper, family, noise, i) - unbiased(lower, family, noise, i);
            const double expected = known * changes.variance[family][i], most = std::sqrt(most_surprising * expected);
            changes.drift[family][i] = static_cast<float>(std::clamp(change, -most, most));
            changes.square[family][i] =
                static_cast<float>(std::min<double>(change * change / expected, most_surprising));
        }
        if (family == static_cast<int>(Family::fine_sphere)) {
            changes.saddle.resize(count);
            for (std::size_t i = 0; i < count; ++i) changes.saddle[i] = saddle(lower.tensor[family][i]);
            near_by.push_back(&changes.saddle);
        }
        near_by.push_back(&changes.square[family]), near_by.push_back(&changes.drift[family]);
    }
    diffuse(near_by, level_.graph, near_reach, run_);
    changes.near = changes.square;
    diffuse(squares, level_.graph, wide_reach_ - near_reach, run_);
    diffuse(densities, level_.graph, 1, run_);
    return changes;
}

/// Are residuals in windows of this size well above the noise? They have met another sheet, the far side, an edge.
bool Ladder::misfits(int family, float residual, float size, float density, bool hole, std::size_t i) const {
    const float noise = standing_.noise[i];
    bool borne = false;
    if (of_spheres(family) && level_.members > 1) {
        borne = !meets_far_side(residual, noise, size) && (of_fine_spheres(family) || residual <= most_borne * noise);
        if (family == static_cast<int>(Family::fine_sphere)) borne |= is_bend(residual, noise, size, density, hole);
    }
    return residual > traits[static_cast<std::size_t>(family)].fitting * noise && size * size > 20 * noise && !borne;
}

/// Mix in a family's values.
void Ladder::weigh_family(int rung, int family, const Rung& lower, const Rung& upper, const Changes& changes) {
    const Traits& known = traits[static_cast<std::size_t>(family)];
    const std::size_t count = level_.count();
    const Field& noise = standing_.noise;
    const Field &variance = changes.variance[family], &change = changes.square[family], &near = changes.near[family],
                &around = changes.around[family];
    Field& known_bias = standing_.bias[family];
    const auto share = static_cast<float>(level_.members >= members_where_wide ? known.share_where_wide : 1);
    const std::size_t q = fit_of(family);
    const bool fine = family == static_cast<int>(Family::fine_sphere);
    for (std::size_t i = 0; i < count; ++i) {
        const float feared_below = fine ? std::exchange(feared_[i], nan) : nan;
        const float below = of_spheres(family) ? std::exchange(standing_.below[family][i], nan) : nan;
        if (!standing_.active[i] || !std::isfinite(lower.density[family][i])) continue;
        const bool hole = fine && is_hole(changes.saddle[i]);
        // What misfits does so on every rung above, once the windows are wide enough to tell noise; before that a
        // tilted view may be all there is to it.
        const bool misfit = rung > 0 && misfits(family, residual_[q][i], lower.size[i], around[i], hole, i);
        if (misfit && standing_.settled[i]) standing_.dead[family][i] = 1;
        if (misfit || standing_.dead[family][i]) continue;
        // The bias does not fall on the way up, though what the next rung changes does where all is smoothed away.
        const double expected = known.change * variance[i];
        const double growth = bias_growth(lower, family, i);
        const double by_noise = variance[i];
        const auto squared_error = [&](double more, double growth_of_bias) {
            const double bias = expected / (growth_of_bias * growth_of_bias) * more;
            return static_cast<float>(by_noise + std::max<double>(bias, known_bias[i]));
        };
        const bool next_too_wide = of_spheres(family) &&
                                   misfits(family, wider_[q][i], upper.size[i], around[i], hole, i) &&
                                   meets_far_side(wider_[q][i], noise[i], upper.size[i]);
        float feared = std::max(change[i], near[i] - not_feared_near);
        if (fine) feared_[i] = feared;
        if (hole && next_too_wide && feared_below < feared) feared = feared_below;
        const float risk = squared_error(feared, growth);
        // What is told of the error is only what is not usual of noise.
        const float error = squared_error(
            (next_too_wide ? telling_of_too_wide : 1) * std::max({0.0F, change[i] - usual, near[i] - usual_near}),
            known.told * growth);
        if (!(risk < never)) continue;
        // Where noise is as large as the value, its tails are no measure of anything. The value is not more than the
        // mean's, which noise raises least: that of slopes near a border may be all noise.
        const double density = lower.density[family][i];
        const double least_raised = std::min<double>(density, lower.density[static_cast<int>(Family::mean)][i]);
        const double surely = std::max(change[i] - sure, near[i] - sure_near);
        if (variance[i] < 0.1 * least_raised * least_raised && surely > 0) {
            const double step = std::sqrt(expected * surely);
            known_bias[i] =
                static_cast<float>(std::pow(std::max(step / growth, std::sqrt(double(known_bias[i]))) + step, 2));
        }
        // Far above its own best it will not come back, nor where its bias alone, which does not fall, is far above the
        // best of all.
        if (standing_.settled[i]) {
            standing_.least[family][i] = std::min(standing_.least[family][i], risk);
            if (risk > far_above * standing_.least[family][i] || known_bias[i] > far_above * least_of_all(i))
                standing_.dead[family][i] = 1;
        }
        double bias = signed_bias(changes.drift[family][i], expected, growth);
        if (of_spheres(family)) {
            standing_.below[family][i] = static_cast<float>(bias);
            if (next_too_wide && hole)
                bias = 0;
            else if (next_too_wide && std::isfinite(below))
                bias = 0.5 * (bias + (1 + growth) * below);
        }
        if (std::pow(density - around[i], 2) > outlying * risk) continue;
        const double value = std::max(0.0, unbiased(lower, family, noise, i) - bias);
        const Estimate estimate = {value,
                                   risk,
                                   error,
                                   static_cast<float>(by_noise),
                                   0,
                                   lower.spread[1][i],
                                   lower.normal[i],
                                   scaled(density > 0 ? std::sqrt(value / density) : 1, lower.tensor[family][i]),
                                   rung_choice(rung, static_cast<Family>(family))};
        mix(estimate, weight_of(share * risk), i, measured_);
    }
}

void Ladder::weigh(int rung, const Rung& lower, const Rung& upper) {
    const auto averaged = [&](const Rung& found) {
        std::array<Field, 2> residual = {found.residual[0], found.residual[1]};
        diffuse({&residual[0], &residual[1]}, level_.graph, reach_of_variances, run_);
        return residual;
    };
    residual_ = wider_[0].empty() ? averaged(lower) : std::move(wider_);
    wider_ = averaged(upper);
    estimate_noise(rung, lower);
    const Changes changes = find_changes(rung, lower, upper);
    for (int family = 0; family < tried_; ++family) weigh_family(rung, family, lower, upper, changes);
}

/// Elements on which every family has had its best leave the ladder, once their neighbours do not need them either.
void Ladder::let_go() {
    const std::size_t count = level_.count();
    std::vector<std::uint8_t> wanted(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        if (!standing_.active[i]) continue;
        for (int family = 0; family < tried_; ++family) wanted[i] |= standing_.dead[family][i] ? 0 : 1;
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (!standing_.active[i] || wanted[i]) continue;
        bool needed = false;
        for (std::size_t j = 0; j < ElementGraph::degree && level_.graph[i][j] >= 0; ++j)
            needed = needed || wanted[static_cast<std::size_t>(level_.graph[i][j])] == 1;
        standing_.active[i] = needed ? 1 : 0;
    }
}

Level lowest_level(const Elements& elements, double scale, const ElementGraph& graph) {
    Level level;
    const Vec3 origin = elements.position(0);
    level.position.resize(3 * elements.count);
    for (std::size_t i = 0; i < elements.count; ++i)
        store(level.position.data() + 3 * i, scale * (elements.position(i) - origin));
    level.foot = level.position;
    level.normal.assign(elements.count, Vec3{nan, nan, nan});
    level.graph = graph;
    level.area.assign(elements.count, 1);
    return level;
}

Measured measured_so_far(const AutomaticCurvature& result) {
    Measured measured = nothing_measured(result.density.size());
    for (std::size_t i = 0; i < result.density.size(); ++i)
        if (std::isfinite(result.error[i])) {
            measured.risk[i] = static_cast<float>(result.error[i] * result.error[i]);
            measured.weight[i] = weight_of(measured.risk[i]);
        }
    measured.error = measured.noise = measured.risk;
    measured.density = result.density, measured.normal = result.normal;
    measured.tensor = result.tensor, measured.choice = result.choice;
    return measured;
}

/// At corners of borders windows may find no surface at all.
void borrow_on_ladder(const Level& level, Measured& measured, const Execution& run) {
    constexpr int turns = 3;
    std::vector<std::uint8_t> climbed(level.count());
    for (int turn = 0; turn < turns; ++turn) {
        for (std::size_t i = 0; i < level.count(); ++i) climbed[i] = measured.choice[i] >= first_rung_choice;
        borrow(level, climbed, measured, {run.threads, {}});
    }
}

bool any(const std::vector<std::uint8_t>& flags) {
    return std::find(flags.begin(), flags.end(), 1) != flags.end();
}

/// What is handed on from level to level.
struct Climber {
    Standing standing;
    std::optional<FineSurface> fine;  ///< where spheres are tried
    Rung lower;
    int rung;
};

/// Elements can be grouped for the next level in several ways, and what is found differs. So those of a cloud are
/// grouped twice, on the lowest level; of a mesh, whose noise is far below the size of the shape, once.
int groupings(const Elements& elements, const Level& level) {
    return level.members == 1 && !elements.connected ? 2 : 1;
}

/// Climb a level's rungs and the levels above it, and mix what they find into `measured`.
void climb_level(const Elements& elements, Level& level, Climber& climber, Measured& measured, const Execution& run) {
    const int first = climber.rung;
    const auto done = [&](double rung) { return (rung - first) / (most_rungs - first); };
    {
        RungFits fits(elements, level, climber.standing.active, climber.standing.dead,
                      climber.fine ? &*climber.fine : nullptr, run);
        Ladder ladder(elements, level, climber.standing, measured, run);
        for (; climber.rung < most_rungs && level_of(climber.rung) == level_of(first); ++climber.rung) {
            if (rung_neighbors(climber.rung) >= static_cast<int>(elements.count) || !any(climber.standing.active))
                return;
            Rung upper = fits.step(climber.rung);
            if (climber.rung > 0) {
                ladder.weigh(climber.rung - 1, climber.lower, upper);
                ladder.let_go();
            }
            climber.lower = std::move(upper);
            if (run.progress && !run.progress(done(climber.rung + 1))) throw Cancelled();
        }
    }
    if (climber.rung == most_rungs) return;
    std::vector<CoarserLevel> above;
    const int count = groupings(elements, level);
    const double begin = done(climber.rung), share = (1 - begin) / count;
    for (int grouping = 0; grouping < count; ++grouping) {
        CoarserLevel coarser = coarsened(level, grouping, {run.threads, {}});
        Climber next = {coarsened(climber.standing, coarser),
                        grouping + 1 < count ? climber.fine : std::move(climber.fine),
                        at(climber.lower, coarser.representative), climber.rung};
        if (next.fine) next.fine->coarsen(coarser);
        climb_level(elements, coarser.level, next, coarser.measured,
                    part_of(run, begin + grouping * share, begin + (grouping + 1) * share));
        above.push_back(std::move(coarser));
    }
    refine(above, level, measured, {run.threads, {}});
}

}  // namespace

int rung_neighbors(int rung) {
    constexpr int first[rungs_of_level] = {look_neighbors, 35, 50};
    int neighbors = first[rung % rungs_of_level];
    for (; rung >= rungs_of_level; rung -= rungs_of_level) neighbors *= Level::group;
    return neighbors;
}

void climb(const Elements& elements, double scale, const ElementGraph& graph, std::vector<std::uint8_t> active,
           AutomaticCurvature& result, const Execution& run) {
    // A clean cloud needs no room for rungs.
    if (!any(active)) return;
    Level level = lowest_level(elements, scale, graph);
    Measured measured = measured_so_far(result);
    Climber climber = {Standing(std::move(active)), {}, Rung(), 0};
    if (spheres_tried(elements)) climber.fine.emplace(level);
    climb_level(elements, level, climber, measured, run);
    borrow_on_ladder(level, measured, run);
    // Noisy meshes would be 8 to 12 % nearer, but tubes among them by more than others, which the errors do not tell.
    if (!elements.connected) smooth_densities(level, climber.standing.noise, measured, {run.threads, {}});
    add_window_bias(graph, measured, {run.threads, {}});
    if (spheres_tried(elements)) tell_sphere_errors(level, climber.standing.noise, measured, {run.threads, {}});
    for (std::size_t i = 0; i < elements.count; ++i)
        if (measured.choice[i] >= first_rung_choice) result.error[i] = std::sqrt(measured.error[i]);
    result.density = measured.density, result.normal = measured.normal;
    result.tensor = measured.tensor, result.choice = measured.choice;
}

}  // namespace gaussmap
