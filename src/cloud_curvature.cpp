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
#include "estimators.h"
#include "fan.h"
#include "fan_energy.h"
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

/// Of the fan of a point.
void measure_tensor(const Work& work, const Chains& chains, const Chains::One& fan, bool align, Neighborhood& corners,
                    CloudCurvature& result) {
    const auto i = static_cast<std::size_t>(fan.point);
    corners.gather(work.cloud, i, chains.begin(fan), fan.size);
    store(result.tensor, work.source(i), fan_tensor(corners, fan.closed, work.normals.data(), work.normal(i), align));
}

/// The last stage: densities of fans whose normals are all there.
void measure(const Work& work, const Chains& chains, CloudCurvature& result) {
    const FanNormals normals = {work.normals.data(), !work.given && work.options.orientation == Orientation::local};
    const auto place = [&](std::size_t f) { return work.source(static_cast<std::size_t>(chains.fans[f].point)); };
    constexpr std::size_t ahead = 8;
    LaneStrips strips;
    LaneEnergies energies;
    Neighborhood corners(work.options.tensor ? work.k : 0);
    for (std::size_t f = 0; f < chains.fans.size(); ++f) {
        // Places of the input may be anywhere in memory.
        if (f + ahead < chains.fans.size()) {
            __builtin_prefetch(&result.kappa[place(f + ahead)], 1);
            __builtin_prefetch(&result.density[place(f + ahead)], 1);
        }
        const std::size_t l = f % fit_lanes;
        if (l == 0) fan_energies(work.cloud, normals, chains, f, strips, energies);
        if (!(energies.area[l] > 0)) continue;
        const double scale = chains.fans[f].scale;
        result.kappa[place(f)] = energies.kappa[l];
        result.density[place(f)] = energies.kappa[l] / energies.area[l] * scale * scale;
        if (work.options.tensor) measure_tensor(work, chains, chains.fans[f], normals.align, corners, result);
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
          around_(batch / fit_lanes, LaneNeighborhoods(work.k)),
          normals_of_(work.options.method, work.options.degree, work.k),
          fans_(fit_lanes, Fan(work.k)) {}

    void run(CloudCurvature& result) {
        Lap lap;
        for (std::size_t i = first_; i < last_; i += batch) {
            const std::size_t end = std::min(i + batch, last_);
            lap.add_to(block_.seconds_curvature);
            const std::int32_t* const rows = find(i, end);
            lap.add_to(block_.seconds_neighbors);
            if (!work_.given)
                for (std::size_t j = i; j < end; j += fit_lanes) fit(around_[(j - i) / fit_lanes], j);
            lap.add_to(block_.seconds_normals);
            for (std::size_t j = i; j < end; j += fit_lanes)
                build(around_[(j - i) / fit_lanes], j, rows + (j - i) * work_.k);
        }
        measure(work_, ready_, result);
        lap.add_to(block_.seconds_curvature);
    }

  private:
    /// The rows and neighbourhoods of points [i, end), a leaf.
    const std::int32_t* find(std::size_t i, std::size_t end) {
        const bool keep = work_.spanning_tree();
        std::int32_t* rows = keep ? work_.neighbors.index.data() + i * work_.k : rows_.data();
        search_.find(i / leaf_points, rows, work_.k, i);
        for (std::size_t j = i; j < end; j += fit_lanes)
            around_[(j - i) / fit_lanes].gather(work_.cloud, j, std::min<std::size_t>(fit_lanes, end - j),
                                                rows + (j - i) * work_.k, work_.k);
        return rows;
    }

    /// The normals of the points from i on.
    void fit(LaneNeighborhoods& around, std::size_t i) {
        NormalFit::Result results[fit_lanes];
        normals_of_(around, results);
        for (std::size_t l = 0; l < around.count(); ++l) {
            store(work_.normals.data() + 3 * (i + l), results[l].normal);
            if (results[l].lowered) ++block_.lowered;
        }
    }

    void build(LaneNeighborhoods& around, std::size_t i, const std::int32_t* rows) {
        // Looking up, whichever way the normal looks: a flip of all normals changes no bit of the sums.
        Vec3 normals[fit_lanes];
        for (std::size_t l = 0; l < around.count(); ++l) normals[l] = upward(work_.normal(i + l));
        build_fans(around, normals, fans_);
        for (std::size_t l = 0; l < around.count(); ++l) keep(fans_[l], i + l, rows + l * work_.k, around.scale(l));
    }

    void keep(const Fan& fan, std::size_t i, const std::int32_t* row, double scale) {
        if (fan.triangles() == 0) return;
        if (!fan.closed) ++block_.boundary;
        bool inside = true;
        for (std::size_t c = 0; c < fan.corners; ++c) {
            const auto corner = static_cast<std::size_t>(row[fan.chain[c]]);
            inside = inside && corner >= first_ && corner < last_;
        }
        const bool ready = work_.given || (inside && !work_.spanning_tree());
        const Chains::One one = {scale, static_cast<std::int32_t>(i), 0, static_cast<std::uint32_t>(fan.corners),
                                 fan.closed};
        (ready ? ready_ : block_.waiting).add(one, fan.chain.data(), row);
    }

    Work& work_;
    Block& block_;
    std::size_t first_, last_;
    NeighborRows search_;
    std::vector<std::int32_t> rows_;
    std::vector<LaneNeighborhoods> around_;
    NormalFit normals_of_;
    std::vector<Fan> fans_;
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
