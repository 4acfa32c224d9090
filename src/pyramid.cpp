#include "pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "frame.h"
#include "gaussmap/neighbors.h"
#include "lane_averages.h"
#include "parallel.h"
#include "unit_cholesky.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1024;

void build_graph(Level& level, const NeighborIndex& feet, const Execution& run) {
    constexpr std::size_t degree = ElementGraph::degree;
    const std::size_t count = level.count();
    level.graph.index.assign(count * degree, -1);
    const NearestPoints found = feet.nearest(Points(level.foot), static_cast<int>(degree + 1), false, run);
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t at = 0;
        for (std::size_t j = 0; j <= degree && at < degree; ++j) {
            const std::int32_t other = found.index[i * found.k + j];
            if (other >= 0 && static_cast<std::size_t>(other) != i) level.graph.index[i * degree + at++] = other;
        }
    }
}

/// Squared distance of the farthest neighbour in the graph.
double reach(const Level& level, std::size_t i) {
    double farthest = 0;
    for (std::size_t j = 0; j < ElementGraph::degree && level.graph[i][j] >= 0; ++j)
        farthest =
            std::max(farthest, squared(level.foot_of(static_cast<std::size_t>(level.graph[i][j])) - level.foot_of(i)));
    return farthest;
}

/// Least squares for polynomials of several values at once; only the values at the origin are asked for.
class LocalFit {
  public:
    static constexpr int values = 10;

    void add(double weight, double u, double v, const std::array<double, values>& value) {
        // The constant comes last, so that the last row of the triangular system holds all that is asked for.
        const double m[most] = {u * u, u * v, v * v, u, v, 1};
        for (int i = 0; i < most; ++i) {
            for (int j = 0; j <= i; ++j) a_[i][j] += weight * m[i] * m[j];
            for (int s = 0; s < values; ++s) y_[i][s] += weight * m[i] * value[static_cast<std::size_t>(s)];
        }
        ++count_;
    }

    /// False where the data do not determine a quadric well.
    bool quadric(std::array<double, values>& at_origin) const { return count_ >= 9 && solve<6>(at_origin); }
    /// The mean where the data do not determine a plane well.
    void plane(std::array<double, values>& at_origin) const {
        if (count_ < 5 || !solve<3>(at_origin)) mean(at_origin);
    }
    void mean(std::array<double, values>& at_origin) const { solve<1>(at_origin); }

  private:
    template <int Terms>
    bool solve(std::array<double, values>& result) const {
        constexpr double rank_tolerance = 0.02;
        constexpr int first = most - Terms, last = Terms - 1;
        double a[Terms][Terms], scale[Terms];
        if (!unit_cholesky(a_, rank_tolerance, a, scale)) return false;
        for (int s = 0; s < values; ++s) {
            double y[Terms];
            for (int i = 0; i < Terms; ++i) {
                y[i] = y_[first + i][s] * scale[i];
                for (int k = 0; k < i; ++k) y[i] -= a[i][k] * y[k];
                y[i] /= a[i][i];
            }
            result[static_cast<std::size_t>(s)] = y[last] / a[last][last] * scale[last];
        }
        return true;
    }

    static constexpr int most = 6;
    double a_[most][most] = {}, y_[most][values] = {};
    int count_ = 0;
};

/// Errors are worlds apart where one squared is this many times the other.
constexpr float apart = 9;
/// What weighs less than this part of what there is changes nothing that matters.
constexpr double negligible = 1e-3;

enum class Order { quadric, quadric_or_plane, mean };

/// What is known about the element `from`, interpolated among it and its neighbours at a foot nearby; nothing where
/// they do not tell.
std::optional<Estimate> interpolate(const Level& level, const Measured& known, std::size_t from, Vec3 foot,
                                    Order order) {
    const Vec3 normal = known.normal[from];
    const Frame frame = frame_about(normal);
    const double radius2 = reach(level, from);
    // Far away nothing is known.
    if (squared(level.foot_of(from) - foot) > 16 * radius2) return {};
    const double unit = 1 / std::sqrt(std::max(radius2, std::numeric_limits<double>::min()));
    LocalFit fit;
    const auto take = [&](std::size_t g) {
        if (!(known.risk[g] < apart * known.risk[from])) return;
        const double along = dot(known.normal[g], normal);
        if (!(std::abs(along) >= one_sheet)) return;
        const double sign = along < 0 ? -1 : 1;
        const Vec3 there = sign * known.normal[g], d = unit * (level.foot_of(g) - foot);
        // Nearly through the nearest; their errors are alike anyway.
        const double r = 1 / (squared(d) + 0.02), weight = r * r;
        const Symmetric3 t = carried(known.tensor[g], there, normal);
        fit.add(weight, dot(d, frame.u), dot(d, frame.v),
                {known.density[g], sign * t.xx, sign * t.xy, sign * t.xz, sign * t.yy, sign * t.yz, sign * t.zz,
                 there.x, there.y, there.z});
    };
    take(from);
    for (std::size_t j = 0; j < ElementGraph::degree && level.graph[from][j] >= 0; ++j)
        take(static_cast<std::size_t>(level.graph[from][j]));
    std::array<double, LocalFit::values> value;
    const bool curved = order != Order::mean && fit.quadric(value);
    if (!curved && order == Order::quadric) return {};
    if (order == Order::mean) fit.mean(value);
    if (order == Order::quadric_or_plane && !curved) fit.plane(value);
    const Vec3 turned = gaussmap::unit(Vec3{value[7], value[8], value[9]});
    const Symmetric3 tensor = {value[1], value[2], value[3], value[4], value[5], value[6]};
    return Estimate{std::max(0.0, value[0]),
                    known.risk[from],
                    known.error[from],
                    known.noise[from],
                    known.disagreement[from],
                    known.cut[from],
                    turned,
                    carried(tensor, normal, turned),
                    known.choice[from]};
}

/// The member whose foot is nearest to the mean of all feet.
std::size_t middle_member(const Level& level, std::span<const std::int32_t> members) {
    Vec3 middle;
    for (const std::int32_t member : members) middle = middle + level.foot_of(static_cast<std::size_t>(member));
    middle = 1.0 / static_cast<double>(members.size()) * middle;
    const auto away = [&](std::int32_t member) {
        return squared(level.foot_of(static_cast<std::size_t>(member)) - middle);
    };
    return static_cast<std::size_t>(*std::min_element(
        members.begin(), members.end(), [&](std::int32_t a, std::int32_t b) { return away(a) < away(b); }));
}

/// Mean height over their feet of the members that are near one and of its sheet, along its normal; 0 where none is
/// known.
double mean_height(const Level& level, std::span<const std::int32_t> members, std::size_t chosen) {
    const double near = 4 * reach(level, chosen);
    double height = 0;
    int counted = 0;
    for (const std::int32_t member : members) {
        const auto other = static_cast<std::size_t>(member);
        const double along = dot(level.normal[other], level.normal[chosen]);
        if (squared(level.foot_of(other) - level.foot_of(chosen)) > near) continue;
        if (other != chosen && !(std::abs(along) >= one_sheet)) continue;
        const double over = dot(level.at(other) - level.foot_of(other), level.normal[other]);
        if (!std::isfinite(over)) continue;
        height += along < 0 ? -over : over;
        ++counted;
    }
    return counted > 0 ? height / counted : 0;
}

}  // namespace

CoarserLevel coarsened(const Level& level, int grouping, const Execution& run) {
    CoarserLevel coarser;
    Level& above = coarser.level;
    const auto shift = static_cast<std::size_t>(grouping);
    const std::size_t count = level.count(), groups = (count + shift + Level::group - 1) / Level::group;
    above.members = level.members * Level::group;
    above.position.resize(3 * groups);
    above.foot.resize(3 * groups);
    above.normal.resize(groups);
    coarser.representative.resize(groups);
    const std::vector<std::int32_t> order = spatial_order(Points(level.foot), run);
    for_blocks(groups, grain, {run.threads, {}}, [&](std::size_t, std::size_t g, std::size_t last) {
        for (; g < last; ++g) {
            const std::size_t begin = std::max(g * Level::group, shift) - shift,
                              end = std::min(count, (g + 1) * Level::group - shift);
            const auto members = std::span(order).subspan(begin, end - begin);
            const std::size_t chosen = middle_member(level, members);
            const Vec3 foot = level.foot_of(chosen), normal = level.normal[chosen];
            const double height = mean_height(level, members, chosen);
            store(above.foot.data() + 3 * g, foot);
            store(above.position.data() + 3 * g, height != 0 ? foot + height * normal : foot);
            above.normal[g] = normal;
            coarser.representative[g] = static_cast<std::int32_t>(chosen);
        }
    });
    const NeighborIndex feet(Points(above.foot), run);
    build_graph(above, feet, run);
    coarser.parent = feet.nearest(Points(level.foot), 1, false, run).index;
    above.area.assign(groups, 0);
    for (std::size_t i = 0; i < count; ++i) above.area[static_cast<std::size_t>(coarser.parent[i])] += level.area[i];
    coarser.measured = nothing_measured(groups);
    return coarser;
}

Measured nothing_measured(std::size_t count) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    Measured measured;
    measured.density.assign(count, nan);
    measured.risk.assign(count, std::numeric_limits<float>::infinity());
    measured.error = measured.noise = measured.risk;
    measured.disagreement.assign(count, 0);
    measured.cut.assign(count, 1);
    measured.weight.assign(count, 0);
    measured.normal.assign(count, Vec3{nan, nan, nan});
    measured.tensor.resize(count);
    measured.choice.assign(count, 0);
    return measured;
}

void mix(const Estimate& estimate, double weight, std::size_t i, Measured& measured) {
    const bool best = estimate.risk < measured.risk[i];
    const double so_far = measured.weight[i], part = weight / (weight + so_far);
    if (!(part > 0)) return;
    if (so_far > 0) {
        const Vec3 normal = best ? estimate.normal : measured.normal[i];
        const auto seen_along = [&](const Symmetric3& tensor, Vec3 from, double share, Symmetric3& sum) {
            const double sign = dot(from, normal) < 0 ? -1 : 1;
            add(sum, sign * share, carried(tensor, sign * from, normal));
        };
        Symmetric3 sum;
        seen_along(measured.tensor[i], measured.normal[i], 1 - part, sum);
        seen_along(estimate.tensor, estimate.normal, part, sum);
        measured.tensor[i] = sum;
        const double change = estimate.density - measured.density[i];
        measured.density[i] += part * change;
        measured.disagreement[i] =
            static_cast<float>(part * double(estimate.disagreement) +
                               (1 - part) * (double(measured.disagreement[i]) + part * change * change));
    } else {
        measured.tensor[i] = estimate.tensor;
        measured.density[i] = estimate.density;
        measured.disagreement[i] = estimate.disagreement;
    }
    measured.weight[i] += weight;
    if (!best) return;
    measured.risk[i] = estimate.risk, measured.error[i] = estimate.error, measured.noise[i] = estimate.noise;
    measured.cut[i] = estimate.cut;
    measured.normal[i] = estimate.normal;
    measured.choice[i] = estimate.choice;
}

void refine(const std::vector<CoarserLevel>& groupings, const Level& level, Measured& fine, const Execution& run) {
    const auto count = static_cast<double>(groupings.size());
    for_blocks(level.count(), grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) {
            double sum = 0;
            for (const CoarserLevel& above : groupings)
                sum += above.measured.weight[static_cast<std::size_t>(above.parent[i])];
            const double weight = sum / count;
            if (!(weight > negligible * fine.weight[i])) continue;
            const float so_far = fine.risk[i];
            for (const CoarserLevel& above : groupings) {
                const auto parent = static_cast<std::size_t>(above.parent[i]);
                // At the edge of a region that went on climbing too little is around for good interpolation.
                const bool better = apart * above.measured.risk[parent] < so_far;
                const auto found = interpolate(above.level, above.measured, parent, level.foot_of(i),
                                               better ? Order::quadric_or_plane : Order::quadric);
                if (found) mix(*found, weight / count, i, fine);
            }
        }
    });
}

void borrow(const Level& level, const std::vector<std::uint8_t>& lends, Measured& measured, const Execution& run) {
    const Measured known = measured;
    for_blocks(level.count(), grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) {
            std::size_t best = i;
            for (std::size_t j = 0; j < ElementGraph::degree && level.graph[i][j] >= 0; ++j) {
                const auto other = static_cast<std::size_t>(level.graph[i][j]);
                if (lends[other] && known.risk[other] < known.risk[best]) best = other;
            }
            // Only who does not know the size of it asks others.
            const bool hopeless = known.risk[i] > 0.1 * known.density[best] * known.density[best];
            if (!hopeless || !(apart * known.risk[best] < known.risk[i])) continue;
            const auto lent = interpolate(level, known, best, level.foot_of(i), Order::mean);
            if (!lent) continue;
            measured.weight[i] = 0;
            mix(*lent, known.weight[best], i, measured);
        }
    });
}

}  // namespace gaussmap
