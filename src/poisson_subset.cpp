// Sample elimination: candidates in cubes as wide as they see each other, and a heap of how crowded each is.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "arguments.h"
#include "check_cloud.h"
#include "gaussmap/sampling.h"
#include "parallel.h"
#include "vec.h"

namespace gaussmap {
namespace {

constexpr std::size_t block = 4096;

/// Candidates in slots, sorted by the cube that they are in; each cube with the 27 cubes about it.
class Cubes {
  public:
    Cubes(Points points, double side, const Execution& run);

    /// Call visit(slot, distance) for each other one nearer than a side.
    template <class Visit>
    void near(std::size_t slot, Visit&& visit) const {
        const Vec3 p = places_[slot];
        const double most = side_ * side_;
        for (const auto& [begin, end] : about_[cube_of_[slot]])
            for (std::size_t i = begin; i < end; ++i)
                if (const double distance = squared(places_[i] - p); distance < most && i != slot)
                    visit(i, std::sqrt(distance));
    }
    std::int32_t candidate(std::size_t slot) const { return static_cast<std::int32_t>(candidate_[slot]); }

  private:
    using Range = std::pair<std::uint32_t, std::uint32_t>;

    /// Numbers beyond 21 bits wrap; what then looks near is told apart by distance.
    std::uint64_t key(Vec3 p, int dx, int dy, int dz) const {
        const auto number = [&](double v, int step) {
            const auto n = static_cast<std::int64_t>(std::fmod(std::floor(v / side_), 0x1p21));
            return static_cast<std::uint64_t>(n + step) & 0x1fffff;
        };
        return number(p.x, dx) << 42 | number(p.y, dy) << 21 | number(p.z, dz);
    }

    double side_;
    std::vector<std::uint32_t> candidate_, cube_of_;  ///< of slots
    std::vector<Vec3> places_;                        ///< of slots
    std::vector<std::vector<Range>> about_;
};

Cubes::Cubes(Points points, double side, const Execution& run) : side_(side) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(points.count);
    for_blocks(points.count, block, run, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) keys[i] = {key(load(points[i]), 0, 0, 0), static_cast<std::uint32_t>(i)};
    });
    std::sort(keys.begin(), keys.end());
    candidate_.resize(points.count), places_.resize(points.count), cube_of_.resize(points.count);
    std::vector<std::uint64_t> cubes;
    std::vector<std::uint32_t> begins;
    for (std::uint32_t i = 0; i < keys.size(); ++i) {
        if (cubes.empty() || keys[i].first != cubes.back()) cubes.push_back(keys[i].first), begins.push_back(i);
        candidate_[i] = keys[i].second;
        places_[i] = load(points[candidate_[i]]);
        cube_of_[i] = static_cast<std::uint32_t>(cubes.size() - 1);
    }
    begins.push_back(static_cast<std::uint32_t>(points.count));
    about_.resize(cubes.size());
    for_blocks(cubes.size(), block, run, [&](std::size_t, std::size_t c, std::size_t last) {
        for (; c < last; ++c)
            for (int d = 0; d < 27; ++d) {
                const std::uint64_t wanted = key(places_[begins[c]], d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
                const auto found = std::lower_bound(cubes.begin(), cubes.end(), wanted);
                if (found == cubes.end() || *found != wanted) continue;
                const auto at = static_cast<std::size_t>(found - cubes.begin());
                about_[c].emplace_back(begins[at], begins[at + 1]);
            }
    });
}

/// A heap of slots, four children a node, the heaviest on top, of equal ones the last; weights only fall.
class Heap {
  public:
    explicit Heap(const std::vector<double>& weights) : heap_(weights.size()), at_(weights.size()) {
        for (std::uint32_t slot = 0; slot < heap_.size(); ++slot) place(slot, {weights[slot], slot});
        for (std::size_t i = heap_.size(); i-- > 0;) sink(i);
    }

    bool holds(std::size_t slot) const { return at_[slot] != gone; }

    std::size_t pop() {
        const std::uint32_t top = heap_.front().slot;
        at_[top] = gone;
        const Node last = heap_.back();
        heap_.pop_back();
        if (!heap_.empty()) place(0, last), sink(0);
        return top;
    }
    void lower(std::size_t slot, double by) {
        heap_[at_[slot]].weight -= by;
        sink(at_[slot]);
    }

  private:
    static constexpr std::uint32_t gone = 0xffffffff;
    static constexpr std::size_t arity = 4;
    struct Node {
        double weight;
        std::uint32_t slot;
    };

    static bool heavier(const Node& a, const Node& b) {
        return a.weight > b.weight || (a.weight == b.weight && a.slot > b.slot);
    }
    void place(std::size_t i, const Node& node) {
        heap_[i] = node;
        at_[node.slot] = static_cast<std::uint32_t>(i);
    }
    void sink(std::size_t i) {
        const Node node = heap_[i];
        for (;;) {
            const std::size_t first = arity * i + 1, last = std::min(first + arity, heap_.size());
            if (first >= last) break;
            std::size_t heaviest = first;
            for (std::size_t child = first + 1; child < last; ++child)
                if (heavier(heap_[child], heap_[heaviest])) heaviest = child;
            if (!heavier(heap_[heaviest], node)) break;
            place(i, heap_[heaviest]);
            i = heaviest;
        }
        place(i, node);
    }

    std::vector<Node> heap_;
    std::vector<std::uint32_t> at_;
};

/// How much two candidates crowd each other, rounded so that taking away undoes adding.
double crowding(double distance, double reach) {
    const double far = 1 - distance / reach, square = far * far, fourth = square * square;
    return static_cast<float>(fourth * fourth);
}

}  // namespace

std::vector<std::int32_t> poisson_subset(Points candidates, double area, std::size_t count, const Execution& run) {
    check_countable(candidates);
    require_positive("poisson_subset", "area", area);
    for (std::size_t i = 0; i < candidates.count; ++i)
        if (!finite(load(candidates[i])))
            throw std::invalid_argument("candidates[" + std::to_string(i) + "] is not finite; leave such points out");
    std::vector<std::int32_t> kept;
    if (count == 0) return kept;
    // Twice the radius of the densest packing of `count` disks.
    const double reach = 2 * std::sqrt(area / (2 * std::numbers::sqrt3 * static_cast<double>(count)));
    const Cubes cubes(candidates, reach, part_of(run, 0, 0.1));
    std::vector<double> weights(candidates.count);
    for_blocks(candidates.count, block, part_of(run, 0.1, 0.3), [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i)
            cubes.near(i, [&](std::size_t, double distance) { weights[i] += crowding(distance, reach); });
    });
    Heap heap(weights);
    const std::size_t excess = candidates.count - std::min(candidates.count, count);
    for_blocks(excess, block, {1, part_of(run, 0.3, 1).progress}, [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i)
            cubes.near(heap.pop(), [&](std::size_t other, double distance) {
                if (heap.holds(other)) heap.lower(other, crowding(distance, reach));
            });
    });
    for (std::size_t slot = 0; slot < candidates.count; ++slot)
        if (heap.holds(slot)) kept.push_back(cubes.candidate(slot));
    std::sort(kept.begin(), kept.end());
    return kept;
}

}  // namespace gaussmap
