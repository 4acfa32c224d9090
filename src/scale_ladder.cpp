// Each rung fits half as many neighbours again as the one below. The error of a fit is its variance, known from the
// noise, and its bias, told by what the next rung changes beyond the two fits' noise; both averaged over the surface
// near the element, without which the choice would follow the noise. Comparable: Lepski's rule, 1990, and the
// refined residual squares criterion of Fan and Gijbels, 1995, which choose a bandwidth from such changes.
#include "scale_ladder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "first_look.h"
#include "parallel.h"
#include "patch.h"
#include "shape_tensor.h"

namespace gaussmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float never = std::numeric_limits<float>::infinity();
constexpr int most_samples = 96;  ///< of an average
constexpr double growth = 1.5;    ///< of the neighbours from rung to rung

/// What is known of each family. The variances are those of the geometry alone: discs filled evenly, k neighbours
/// averaged with the kernel 1 − (d/h)².
struct Traits {
    double variance;  ///< relative to the fit's
    double change;    ///< variance of the change to the next rung, relative to the family's own
    double bias;  ///< how much of the bias the next rung adds to it: growth of h² (quadrics) or h⁴ (quartics), less 1
};
constexpr std::array<Traits, families> traits = {
    {{1, 0.70, growth - 1}, {0.215, 0.37, growth - 1}, {0.08, 0.40, growth - 1}, {1, 0.71, growth* growth - 1}}};

constexpr bool of_quartic(int family) {
    return family == static_cast<int>(Family::quartic);
}

using Field = std::vector<float>;

/// What a rung found, an element each; NaN where it was not on the rung. Two of a kind: of the quadric and of the
/// quartic.
struct Rung {
    Field size, half_size;                 ///< distances of the last neighbour and of the one half way
    std::array<Field, 2> variance, trace;  ///< of the density and of the shape operator, for heights of unit variance
    std::array<Field, 2> residual;         ///< variance of the heights about the fit
    std::array<Field, families> density;   ///< |S|², its bias by noise included
    std::array<std::vector<Symmetric3>, families> tensor;

    explicit Rung(std::size_t count) : size(count, nan), half_size(size) {
        for (int q = 0; q < 2; ++q) variance[q] = trace[q] = residual[q] = size;
        for (int f = 0; f < families; ++f) density[f] = size, tensor[f].resize(count);
    }
};

class Ladder {
  public:
    Ladder(const Elements& elements, double scale, const ElementGraph& graph, std::vector<std::uint8_t> active,
           AutomaticCurvature& result, const Execution& run)
        : elements_(elements),
          scale_(scale),
          graph_(graph),
          run_{run.threads, {}},
          active_(std::move(active)),
          result_(result),
          view_(elements.count),
          samples_(elements.count * most_samples),
          noise_(elements.count, nan),
          settled_(elements.count, 0),
          best_(elements.count),
          lower_(elements.count),
          upper_(elements.count) {
        for (std::size_t i = 0; i < elements.count; ++i) {
            const double error = result.error[i];
            best_[i] = std::isfinite(error) ? static_cast<float>(error * error) : never;
        }
        for (int f = 0; f < families; ++f)
            dead_[f].assign(elements.count, 0), least_[f].assign(elements.count, never),
                bias_[f].assign(elements.count, 0);
    }

    void climb(const Execution& run) {
        for (int rung = 0; rung < most_rungs && rung_neighbors(rung) < static_cast<int>(elements_.count); ++rung) {
            if (std::find(active_.begin(), active_.end(), 1) == active_.end()) break;
            fit(rung);
            average();
            if (rung > 0) {
                weigh(rung - 1);
                let_go();
            }
            std::swap(lower_, upper_);
            if (run.progress && !run.progress((rung + 1.0) / most_rungs)) throw Cancelled();
        }
    }

  private:
    void fit(int rung);
    void fit_element(std::size_t i, int rung, const std::vector<Vec3>& neighbors, int count, Moments<2>& quadric,
                     Moments<4>& quartic);
    void sample(std::size_t i, const std::int32_t* row, int k);
    void average();
    void weigh(int rung);
    void estimate_noise(int rung, const Field& residual, const Field& wider);
    void weigh_family(int rung, int family, const Field& residual);
    void let_go();

    Vec3 difference(std::size_t from, std::size_t to) const {
        return scale_ * (elements_.position(to) - elements_.position(from));
    }

    const Elements& elements_;
    double scale_;
    const ElementGraph& graph_;
    Execution run_;
    std::vector<std::uint8_t> active_;
    AutomaticCurvature& result_;
    std::vector<View> view_;
    std::vector<std::int32_t> samples_;  ///< `most_samples` of the neighbours of each element, nearest first, −1 beyond
    Field noise_;                        ///< variance of the heights
    std::vector<std::uint8_t> settled_, dead_[families];
    Field best_, least_[families];  ///< squared errors: of what `result` holds, and of each family's best
    Field bias_[families];          ///< squared, as far as it is sure on the rungs below
    Rung lower_, upper_;
};

void Ladder::fit(int rung) {
    upper_ = Rung(elements_.count);
    const int k = rung_neighbors(rung);
    for_blocks(elements_.count, Elements::block, run_, [&](std::size_t, std::size_t first, std::size_t last) {
        const auto begin = active_.begin() + static_cast<std::ptrdiff_t>(first),
                   end = active_.begin() + static_cast<std::ptrdiff_t>(last);
        if (std::find(begin, end, 1) == end) return;
        std::vector<std::int32_t> rows((last - first) * static_cast<std::size_t>(k));
        elements_.neighbors(first, last, k, rows.data());
        std::vector<Vec3> neighbors(static_cast<std::size_t>(k));
        Moments<2> quadric;
        Moments<4> quartic;
        for (std::size_t i = first; i < last; ++i) {
            if (!active_[i]) continue;
            const std::int32_t* row = rows.data() + (i - first) * static_cast<std::size_t>(k);
            int count = 0;
            for (; count < k && row[count] >= 0; ++count)
                neighbors[static_cast<std::size_t>(count)] = difference(i, static_cast<std::size_t>(row[count]));
            if (count < k) continue;
            fit_element(i, rung, neighbors, count, quadric, quartic);
            upper_.half_size[i] = static_cast<float>(length(neighbors[static_cast<std::size_t>(k / 2 - 1)]));
            sample(i, row, k);
        }
    });
}

/// Evenly along the row.
void Ladder::sample(std::size_t i, const std::int32_t* row, int k) {
    const int stride = (k + most_samples - 1) / most_samples;
    std::int32_t* to = samples_.data() + i * most_samples;
    for (int s = 0; s < most_samples; ++s) to[s] = s * stride < k ? row[s * stride] : -1;
}

/// Settle the view on a quadric, which noise sways least; what it left before the last turn, infinite where nothing is
/// determined.
double settle_on_quadric(Moments<2>& moments, const std::vector<Vec3>& neighbors, int count, int turns, View& view) {
    double residual = std::numeric_limits<double>::infinity();
    for (; turns > 0 && finite(view.normal); --turns) {
        HeightField<2> field;
        const Frame frame = collect(moments, neighbors.data(), count, true, view, Chart::chord);
        if (!moments.solve(true, field)) break;
        residual = field.residual;
        settle(view, frame, field.c);
    }
    return finite(view.normal) ? residual : std::numeric_limits<double>::infinity();
}

/// The view from the rung below, or while windows are small a fresh one, whichever leaves less: at corners of a noisy
/// border a first view may be tilted beyond recovery.
void Ladder::fit_element(std::size_t i, int rung, const std::vector<Vec3>& neighbors, int count, Moments<2>& quadric,
                         Moments<4>& quartic) {
    constexpr int rungs_of_fresh_views = 6;
    View& view = view_[i];
    view.size = length(neighbors[static_cast<std::size_t>(count) - 1]);
    if (!(view.size > 0)) return;
    double residual = std::numeric_limits<double>::infinity();
    if (rung > 0) residual = settle_on_quadric(quadric, neighbors, count, 1, view);
    if (rung < rungs_of_fresh_views) {
        View fresh = {principal_normal(neighbors, count), {}, view.size};
        const double left = settle_on_quadric(quadric, neighbors, count, 2, fresh);
        if (left < residual) view = fresh, residual = left;
    }
    if (!std::isfinite(residual)) return;
    HeightField<2> curved;
    const Frame frame = collect(quartic, neighbors.data(), count, true, view, Chart::chord);
    HeightField<4> full;
    if (!quartic.solve(true, curved, true)) return;
    upper_.size[i] = static_cast<float>(view.size);
    const double size4 = std::pow(view.size, 4), size6 = std::pow(view.size, 6);
    const auto keep = [&](int q, Family family, const auto& field) {
        const SurfaceJet jet = surface_jet(field.c, frame, view.size);
        const auto f = static_cast<int>(family);
        upper_.tensor[f][i] = jet.tensor;
        upper_.density[f][i] = static_cast<float>(squared_norm(jet.tensor));
        upper_.variance[q][i] = static_cast<float>(density_variance(field) / size6);
        upper_.trace[q][i] = static_cast<float>(shape_variance(field) / size4);
        upper_.residual[q][i] = static_cast<float>(field.residual / std::max(1, field.free) * view.size * view.size);
    };
    keep(0, Family::quadric, curved);
    if (quartic.solve(true, full, true)) keep(1, Family::quartic, full);
}

/// Shape operators of the quadrics, averaged over the samples within half the neighbours' reach and within all of it,
/// with the weights 1 − (d/h)².
void Ladder::average() {
    const auto quadric = static_cast<int>(Family::quadric);
    for_blocks(elements_.count, Elements::block, run_, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) {
            if (!active_[i] || !std::isfinite(upper_.density[quadric][i])) continue;
            const double reach[2] = {double(upper_.half_size[i]) * upper_.half_size[i],
                                     double(upper_.size[i]) * upper_.size[i]};
            const Vec3 normal = view_[i].normal;
            Symmetric3 sum[2] = {upper_.tensor[quadric][i], upper_.tensor[quadric][i]};
            double weights[2] = {1, 1};
            const std::int32_t* row = samples_.data() + i * most_samples;
            for (int s = 0; s < most_samples && row[s] >= 0; ++s) {
                const auto other = static_cast<std::size_t>(row[s]);
                const double along = dot(view_[other].normal, normal), away = squared(difference(i, other));
                // Other sheets and far sides look elsewhere.
                if (!std::isfinite(upper_.density[quadric][other]) || std::abs(along) < 0.3) continue;
                const double sign = along < 0 ? -1 : 1;
                const Symmetric3 there = carried(upper_.tensor[quadric][other], sign * view_[other].normal, normal);
                for (int m = 0; m < 2; ++m) {
                    const double weight = 1 - away / reach[m];
                    if (weight > 0) add(sum[m], sign * weight, there), weights[m] += weight;
                }
            }
            for (int m = 0; m < 2; ++m) {
                const auto family = static_cast<int>(m == 0 ? Family::half_mean : Family::mean);
                Symmetric3 mean;
                add(mean, 1 / weights[m], sum[m]);
                upper_.tensor[family][i] = mean;
                upper_.density[family][i] = static_cast<float>(squared_norm(mean));
            }
        }
    });
}

constexpr int reach_of_errors = 30, reach_of_variances = 15;  ///< steps of diffusion

/// Small windows cut the noise off with their ball, and tell too little; from h > 6.5 σ on it is told, at
/// borders, where windows are half discs, not on the first rungs.
void Ladder::estimate_noise(int rung, const Field& residual, const Field& wider) {
    constexpr int first_to_tell = 3;
    for (std::size_t i = 0; i < elements_.count; ++i) {
        if (settled_[i] || !std::isfinite(residual[i]) || !std::isfinite(wider[i])) continue;
        noise_[i] = static_cast<float>(noise_variance(residual[i], wider[i]));
        settled_[i] = rung >= first_to_tell && lower_.size[i] * lower_.size[i] > 42 * residual[i];
    }
}

/// A change is more than noise where it is this many times what noise is expected to do.
constexpr double sure = 2.5;

/// Take a family's value where it promises a smaller error than what there is.
void Ladder::weigh_family(int rung, int family, const Field& residual) {
    const Traits& known = traits[static_cast<std::size_t>(family)];
    const int q = of_quartic(family) ? 1 : 0;
    const std::size_t count = elements_.count;
    const auto unbiased = [&](const Rung& on, std::size_t i) {
        return on.density[family][i] - noise_[i] * known.variance * on.trace[q][i];
    };
    Field variance(count), change(count);
    for (std::size_t i = 0; i < count; ++i) {
        // The square of what noise adds to the density is of second order, and counts where it is not small.
        const double second = noise_[i] * known.variance * lower_.trace[q][i];
        variance[i] = static_cast<float>(noise_[i] * known.variance * lower_.variance[q][i] + second * second);
        change[i] = static_cast<float>(std::pow(unbiased(upper_, i) - unbiased(lower_, i), 2));
    }
    diffuse(variance, graph_, reach_of_variances, run_);
    diffuse(change, graph_, reach_of_errors, run_);
    for (std::size_t i = 0; i < count; ++i) {
        if (!active_[i] || !std::isfinite(lower_.density[family][i])) continue;
        // Residuals well above the noise: another sheet, the far side, an edge. So they are on every rung above, once
        // the windows are wide enough to tell noise; before that a tilted view may be all there is to it.
        const bool misfit = rung > 0 && residual[i] > 2 * noise_[i] && lower_.size[i] * lower_.size[i] > 20 * noise_[i];
        if (misfit && settled_[i]) dead_[family][i] = 1;
        if (misfit || dead_[family][i]) continue;
        // The bias does not fall on the way up, though what the next rung changes does where all is smoothed away.
        const double noise = known.change * variance[i], per_change = 1 / (known.bias * known.bias);
        const double bias = std::max<double>(per_change * (change[i] - noise), bias_[family][i]);
        const auto risk = static_cast<float>(variance[i] + std::max(0.0, bias));
        if (!(risk < never)) continue;
        // Where noise is as large as the value, its tails are no measure of anything.
        const double density = lower_.density[family][i];
        if (variance[i] < 0.1 * density * density)
            bias_[family][i] = std::max(bias_[family][i], static_cast<float>(per_change * (change[i] - sure * noise)));
        least_[family][i] = std::min(least_[family][i], risk);
        // Far above its own best it will not come back.
        if (risk > 3 * least_[family][i]) dead_[family][i] = 1;
        if (!(risk < best_[i])) continue;
        best_[i] = risk;
        result_.density[i] = std::max(0.0, unbiased(lower_, i));
        result_.error[i] = std::sqrt(risk);
        result_.normal[i] = view_[i].normal;
        result_.tensor[i] = lower_.tensor[family][i];
        result_.choice[i] = rung_choice(rung, static_cast<Family>(family));
    }
}

void Ladder::weigh(int rung) {
    Field residual[2] = {lower_.residual[0], lower_.residual[1]};
    Field wider = upper_.residual[1];
    for (Field* field : {&residual[0], &residual[1], &wider}) diffuse(*field, graph_, reach_of_variances, run_);
    estimate_noise(rung, residual[1], wider);
    for (int family = 0; family < families; ++family) weigh_family(rung, family, residual[of_quartic(family) ? 1 : 0]);
}

/// Elements on which every family has had its best leave the ladder, once their neighbours do not need them either.
void Ladder::let_go() {
    std::vector<std::uint8_t> wanted(elements_.count, 0);
    for (std::size_t i = 0; i < elements_.count; ++i) {
        if (!active_[i]) continue;
        for (int family = 0; family < families; ++family) wanted[i] |= dead_[family][i] ? 0 : 1;
    }
    for (std::size_t i = 0; i < elements_.count; ++i) {
        if (!active_[i] || wanted[i]) continue;
        bool needed = false;
        for (std::size_t j = 0; j < ElementGraph::degree && graph_[i][j] >= 0; ++j)
            needed = needed || wanted[static_cast<std::size_t>(graph_[i][j])] == 1;
        active_[i] = needed ? 1 : 0;
    }
}

}  // namespace

int rung_neighbors(int rung) {
    return static_cast<int>(look_neighbors * std::pow(growth, rung));
}

void climb(const Elements& elements, double scale, const ElementGraph& graph, std::vector<std::uint8_t> active,
           AutomaticCurvature& result, const Execution& run) {
    // A clean cloud needs no room for rungs.
    if (std::find(active.begin(), active.end(), 1) == active.end()) return;
    Ladder(elements, scale, graph, std::move(active), result, run).climb(run);
}

}  // namespace gaussmap
