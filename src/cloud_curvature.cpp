// Total curvature of point clouds: the Dirichlet energy of the normals over each point's Delaunay fan.
//
// The stages: finite points without copies along a space-filling curve (ordered_cloud.h); then, block by block along
// the curve, neighbours, normals (normal_fit.h), fans (fan.h), and densities, written to the points' places in the
// input. A fan whose corners lie in other blocks waits until all normals are there; the rest of what a block works
// with is forgotten with it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "check.h"
#include "check_cloud.h"
#include "clock.h"
#include "degenerate.h"
#include "estimators.h"
#include "fan.h"
#include "fitted_cloud.h"
#include "frame.h"
#include "gaussmap/curvature.h"
#include "neighbor_rows.h"
#include "normal_fit.h"
#include "ordered_cloud.h"
#include "parallel.h"
#include "shape_operator.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 4096;         ///< points a block; whole nodes of the tree
constexpr std::size_t batch = leaf_points;  ///< points that go through the stages of a block together
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Energy {
    double kappa = 0, area = 0;
};

/// Of the triangle (0, a, b) with unit normals at its corners, eq. (3) of docs/method.md:
/// kappa = ½ Σ cot(α) |dn|² over the edges, cot(α) = (product of the edges that meet in α) / (2 area).
Energy triangle_energy(Vec3 a, Vec3 b, Vec3 normal, Vec3 normal_a, Vec3 normal_b) {
    const double at_point = dot(a, b), at_a = dot(a, a - b), at_b = dot(b, b - a);
    const double sum =
        at_point * squared(normal_b - normal_a) + at_a * squared(normal_b - normal) + at_b * squared(normal_a - normal);
    const double cross_squared = squared(cross(a, b));
    if (!std::isfinite(sum) || no_area(cross_squared, at_point + at_a + at_b)) return {};
    const double twice_area = std::sqrt(cross_squared);
    // Never negative; rounding could make it so by its last bit.
    return {std::max(sum, 0.0) / (2 * twice_area), twice_area / 2};
}

/// Over the fan of a point, its corners being the neighbours in turn, in units of the scaled neighbourhood. With
/// `align`, normals that look away from the centre's are turned round.
Energy fan_energy(const Neighborhood& corners, bool closed, const double* normals, Vec3 normal, bool align) {
    const auto normal_of = [&](std::size_t c) {
        const Vec3 other = load(normals + 3 * static_cast<std::size_t>(corners.index[c]));
        return align && dot(other, normal) < 0 ? -other : other;
    };
    Energy sum;
    if (corners.count == 0) return sum;
    std::size_t before = closed ? corners.count - 1 : 0;
    Vec3 normal_before = normal_of(before);
    for (std::size_t c = closed ? 0 : 1; c < corners.count; ++c) {
        const Vec3 normal_here = normal_of(c);
        const Energy energy =
            triangle_energy(corners.offset(before), corners.offset(c), normal, normal_before, normal_here);
        sum.kappa += energy.kappa;
        sum.area += energy.area;
        before = c;
        normal_before = normal_here;
    }
    return sum;
}

/// The fans of some points.
struct Chains {
    struct One {
        std::int32_t point;
        std::uint32_t begin, size;
        bool closed;
    };
    std::vector<One> fans;
    std::vector<std::int32_t> corners;

    void add(std::size_t point, bool closed, const std::int32_t* chain, std::size_t size) {
        fans.push_back({static_cast<std::int32_t>(point), static_cast<std::uint32_t>(corners.size()),
                        static_cast<std::uint32_t>(size), closed});
        corners.insert(corners.end(), chain, chain + size);
    }
};

/// What a block counts, and what it leaves.
struct Block {
    std::size_t lowered = 0, boundary = 0;
    double seconds_neighbors = 0, seconds_normals = 0, seconds_curvature = 0;
    Chains waiting;
};

/// A cloud on its way to the result.
struct Work {
    const CloudCurvatureOptions& options;
    OrderedCloud cloud;
    std::size_t k = 0;            ///< neighbours that a point has
    bool given = false;           ///< normals, which are then there already
    std::vector<double> normals;  ///< of the points of `cloud`
    Neighbors neighbors;          ///< of all points, where a spanning tree will need them; else without rows
    std::vector<Block> blocks;

    bool spanning_tree() const { return !given && options.orientation == Orientation::mst; }
    Vec3 normal(std::size_t i) const { return load(normals.data() + 3 * i); }
    std::size_t source(std::size_t i) const { return static_cast<std::size_t>(cloud.source[i]); }
};

/// Unit normals of the points: the given ones of their first holders.
void take_normals(Points normals, Work& work, const Execution& run) {
    for_blocks(work.cloud.count(), grain, run, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) store(work.normals.data() + 3 * i, unit(load(normals[work.source(i)])));
    });
}

/// The last stage: densities of fans whose normals are all there.
void measure(const Work& work, const Chains& chains, CloudCurvature& result) {
    const bool align = !work.given && work.options.orientation == Orientation::local;
    constexpr std::size_t ahead = 8;
    Neighborhood corners(work.k);
    for (std::size_t f = 0; f < chains.fans.size(); ++f) {
        const Chains::One& fan = chains.fans[f];
        // Places of the input may be anywhere in memory.
        if (f + ahead < chains.fans.size()) {
            const std::size_t later = work.source(static_cast<std::size_t>(chains.fans[f + ahead].point));
            __builtin_prefetch(&result.kappa[later], 1);
            __builtin_prefetch(&result.density[later], 1);
        }
        const auto i = static_cast<std::size_t>(fan.point), place = work.source(i);
        corners.gather(work.cloud, i, chains.corners.data() + fan.begin, fan.size);
        const Energy energy = fan_energy(corners, fan.closed, work.normals.data(), work.normal(i), align);
        if (!(energy.area > 0)) continue;
        result.kappa[place] = energy.kappa;
        result.density[place] = energy.kappa / energy.area * corners.scale * corners.scale;
        if (work.options.tensor)
            store(result.tensor, place, fan_tensor(corners, fan.closed, work.normals.data(), work.normal(i), align));
    }
}

/// The stages of points [first, last), and the room for them.
class BlockWork {
  public:
    BlockWork(Work& work, std::size_t b, std::size_t first, std::size_t last)
        : work_(work),
          block_(work.blocks[b]),
          first_(first),
          last_(last),
          search_(work.cloud.tree, work.k),
          rows_(work.spanning_tree() ? 0 : batch * work.k),
          around_(batch, Neighborhood(work.k)),
          normals_of_(work.options.method, work.options.degree, work.k),
          fan_(work.k),
          chain_(work.k) {}

    void run(CloudCurvature& result) {
        Lap lap;
        for (std::size_t i = first_; i < last_; i += batch) {
            const std::size_t end = std::min(i + batch, last_);
            lap.add_to(block_.seconds_curvature);
            find(i, end);
            lap.add_to(block_.seconds_neighbors);
            if (!work_.given)
                for (std::size_t j = i; j < end; j += fit_lanes) fit(i, j, std::min(j + fit_lanes, end));
            lap.add_to(block_.seconds_normals);
            for (std::size_t j = i; j < end; ++j) build(around_[j - i], j);
        }
        measure(work_, ready_, result);
        lap.add_to(block_.seconds_curvature);
    }

  private:
    /// The neighbourhoods of points [i, end), a leaf.
    void find(std::size_t i, std::size_t end) {
        const bool keep = work_.spanning_tree();
        std::int32_t* rows = keep ? work_.neighbors.index.data() + i * work_.k : rows_.data();
        search_.find(i / leaf_points, rows, work_.k, i);
        for (std::size_t j = i; j < end; ++j) around_[j - i].gather(work_.cloud, j, rows + (j - i) * work_.k, work_.k);
    }

    /// The normals of points [j, end) of the leaf that begins at i.
    void fit(std::size_t i, std::size_t j, std::size_t end) {
        NormalFit::Result results[fit_lanes];
        normals_of_({around_.data() + (j - i), end - j}, {results, end - j});
        for (std::size_t l = 0; l < end - j; ++l) {
            store(work_.normals.data() + 3 * (j + l), results[l].normal);
            if (results[l].lowered) ++block_.lowered;
        }
    }

    void build(const Neighborhood& around, std::size_t i) {
        // Looking up, whichever way the normal looks: a flip of all normals changes no bit of the sums.
        build_fan(around, upward(work_.normal(i)), fan_);
        if (fan_.triangles() == 0) return;
        if (!fan_.closed) ++block_.boundary;
        bool inside = true;
        for (std::size_t c = 0; c < fan_.corners; ++c) {
            chain_[c] = around.index[static_cast<std::size_t>(fan_.chain[c])];
            const auto corner = static_cast<std::size_t>(chain_[c]);
            inside = inside && corner >= first_ && corner < last_;
        }
        const bool ready = work_.given || (inside && !work_.spanning_tree());
        (ready ? ready_ : block_.waiting).add(i, fan_.closed, chain_.data(), fan_.corners);
    }

    Work& work_;
    Block& block_;
    std::size_t first_, last_;
    NeighborRows search_;
    std::vector<std::int32_t> rows_;
    std::vector<Neighborhood> around_;
    NormalFit normals_of_;
    Fan fan_;
    std::vector<std::int32_t> chain_;
    Chains ready_;
};

/// Neighbours, normals and fans, and densities where they can be told; the stages take turns, and share the time.
void run_blocks(Work& work, const Execution& run, CloudCurvature& result) {
    const auto start = Clock::now();
    for_blocks(work.cloud.count(), grain, run, [&](std::size_t b, std::size_t first, std::size_t last) {
        BlockWork(work, b, first, last).run(result);
    });
    double neighbors = 0, normals = 0, curvature = 0;
    for (const Block& block : work.blocks) {
        result.lowered += block.lowered;
        result.boundary += block.boundary;
        neighbors += block.seconds_neighbors;
        normals += block.seconds_normals;
        curvature += block.seconds_curvature;
    }
    const double all = neighbors + normals + curvature, share = all > 0 ? seconds_since(start) / all : 0;
    result.seconds_neighbors += share * neighbors;
    result.seconds_normals += share * normals;
    result.seconds_curvature += share * curvature;
}

void orient(Work& work, const Execution& run) {
    std::vector<double> points(3 * work.cloud.count());
    for (std::size_t i = 0; i < work.cloud.count(); ++i) store(points.data() + 3 * i, work.cloud[i]);
    orient_normals(points, work.neighbors, work.normals, run);
}

/// Back to the order of the input; copies of a point get what its first holder got.
void place_normals(const Work& work, CloudCurvature& result) {
    for (std::size_t i = 0; i < work.cloud.count(); ++i)
        store(result.normals.data() + 3 * work.source(i), work.normal(i));
    for (const auto& [index, first] : work.cloud.copies) {
        const auto to = static_cast<std::size_t>(index), from = static_cast<std::size_t>(first);
        result.density[to] = result.density[from];
        result.kappa[to] = result.kappa[from];
        if (!result.tensor.k1.empty()) copy(result.tensor, from, to);
        store(result.normals.data() + 3 * to, load(result.normals.data() + 3 * from));
    }
}

void check(Points points, Points normals, const CloudCurvatureOptions& options) {
    check_estimator(options.estimator, Input::cloud, options.confidence);
    if (options.k < 3)
        throw std::invalid_argument("k = " + std::to_string(options.k) +
                                    " is too small; a fan takes at least 3 neighbours");
    check_degree(options.degree);
    if (options.estimator == Estimator::jet) check_jet(options.k, options.degree);
    if (!normals.empty()) check_count("normals", normals.count, points.count, "points");
}

}  // namespace

CloudCurvature cloud_curvature(Points points, Points normals, const CloudCurvatureOptions& options) {
    check(points, normals, options);
    if (options.estimator != Estimator::dirichlet) return fitted_cloud(points, normals, options);
    CloudCurvature result;
    Lap lap;
    Work work = {options, ordered_cloud(points, part_of(options.run, 0, 0.2)), 0, false, {}, {}, {}};
    const std::size_t count = work.cloud.count();
    result.duplicates = work.cloud.copies.size();
    result.non_finite = work.cloud.non_finite;
    lap.add_to(result.seconds_neighbors);

    work.k = std::min<std::size_t>(static_cast<std::size_t>(options.k), std::max<std::size_t>(count, 1) - 1);
    work.given = !normals.empty();
    work.normals.resize(3 * count);
    work.blocks.resize(block_count(count, grain));
    if (work.given) take_normals(normals, work, part_of(options.run, 0.2, 0.3));
    if (work.spanning_tree()) work.neighbors = {work.k, std::vector<std::int32_t>(count * work.k)};
    result.density.assign(points.count, nan);
    result.kappa.assign(points.count, nan);
    if (options.tensor) result.tensor = undefined_tensor(points.count);
    lap.add_to(result.seconds_normals);

    run_blocks(work, part_of(options.run, 0.3, work.spanning_tree() ? 0.7 : 0.9), result);
    lap.restart();
    if (work.spanning_tree()) orient(work, part_of(options.run, 0.7, 0.9));
    lap.add_to(result.seconds_normals);
    for_blocks(work.blocks.size(), 1, part_of(options.run, 0.9, 1),
               [&](std::size_t b, std::size_t, std::size_t) { measure(work, work.blocks[b].waiting, result); });
    work.cloud.tree = {};
    result.normals.assign(3 * points.count, nan);
    place_normals(work, result);
    for (const double density : result.density) result.undefined += std::isnan(density) ? 1 : 0;
    lap.add_to(result.seconds_curvature);
    return result;
}

}  // namespace gaussmap
