// Points on a surface: drawn by area, and what elimination leaves of them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "arguments.h"
#include "check.h"
#include "closest_tree.h"
#include "frame.h"
#include "gaussmap/sampling.h"
#include "parallel.h"
#include "random.h"
#include "surface_samples.h"

namespace gaussmap {
namespace {

constexpr std::size_t block = 4096;
constexpr std::size_t candidates_a_point = 5;
constexpr std::size_t most_points = std::size_t{1} << 27;

/// Ends of the faces' areas laid end to end. \throw std::invalid_argument where there is none to sample.
std::vector<double> laid_out_areas(Points vertices, Triangles faces) {
    if (faces.empty()) throw std::invalid_argument("faces is empty; only a surface can be sampled");
    check_surface(vertices, faces);
    std::vector<double> ends = area_ends(vertices, faces);
    if (!(ends.back() > 0)) throw std::invalid_argument("faces have no area; there is nothing to sample");
    if (!std::isfinite(ends.back()))
        throw std::invalid_argument("faces have an area that is too large to be computed; use another unit");
    return ends;
}

/// The rows `kept` of what is there.
SurfacePoints rows_of(const SurfacePoints& all, const std::vector<std::int32_t>& kept) {
    SurfacePoints rows;
    for (const std::int32_t k : kept) {
        const auto i = static_cast<std::size_t>(k);
        rows.points.insert(rows.points.end(), &all.points[3 * i], &all.points[3 * i] + 3);
        rows.weights.insert(rows.weights.end(), &all.weights[3 * i], &all.weights[3 * i] + 3);
        rows.face.push_back(all.face[i]);
    }
    return rows;
}

/// A random half of the rows, in their order.
std::vector<std::int32_t> random_half(std::size_t count, std::uint64_t seed) {
    std::vector<std::int32_t> half;
    Random random(seed, std::numeric_limits<std::uint64_t>::max());
    std::size_t wanted = count / 2;
    for (std::size_t i = 0; i < count; ++i)  // each with a chance of those still wanted among those still to come
        if (random.uniform() * static_cast<double>(count - i) < static_cast<double>(wanted)) {
            half.push_back(static_cast<std::int32_t>(i));
            --wanted;
        }
    return half;
}

class Sampler {
  public:
    Sampler(Points vertices, Triangles faces, std::uint64_t seed)
        : vertices_(vertices), faces_(faces), seed_(seed), ends_(laid_out_areas(vertices, faces)) {}

    /// Independent points, or one in each of `count` equal parts of the area.
    SurfacePoints draw(std::size_t count, bool one_a_part, const Execution& run) const {
        SurfacePoints drawn{std::vector<double>(3 * count), std::vector<std::int32_t>(count),
                            std::vector<double>(3 * count)};
        for_blocks(count, block, run, [&](std::size_t, std::size_t i, std::size_t last) {
            for (; i < last; ++i) {
                Random random(seed_, i);
                const double u = random.uniform();
                const double at = one_a_part ? (static_cast<double>(i) + u) / static_cast<double>(count) : u;
                put(drawn, i, face_at(at * ends_.back()), {random.uniform(), random.uniform()});
            }
        });
        return drawn;
    }

    SurfacePoints poisson(std::size_t count, const Execution& run) const {
        const SurfacePoints candidates = draw(candidates_a_point * count, true, part_of(run, 0, 0.1));
        return rows_of(candidates, poisson_subset(candidates.points, 0.5 * ends_.back(), count, part_of(run, 0.1, 1)));
    }

  private:
    std::size_t face_at(double place) const {
        const auto found = std::upper_bound(ends_.begin(), ends_.end(), place);
        if (found != ends_.end()) return static_cast<std::size_t>(found - ends_.begin());
        // Rounded up to the very end: the last face that has an area.
        return static_cast<std::size_t>(std::lower_bound(ends_.begin(), ends_.end(), ends_.back()) - ends_.begin());
    }
    void put(SurfacePoints& into, std::size_t i, std::size_t face, SquarePoint at) const {
        at = folded(at);
        const double weights[3] = {1 - at.u - at.v, at.u, at.v};
        std::copy(weights, weights + 3, &into.weights[3 * i]);
        into.face[i] = static_cast<std::int32_t>(face);
        const auto corner = [&](int c) { return load(vertices_[static_cast<std::size_t>(faces_[face][c])]); };
        store(&into.points[3 * i], in_triangle(corner(0), corner(1), corner(2), at));
    }

    Points vertices_;
    Triangles faces_;
    std::uint64_t seed_;
    std::vector<double> ends_;  ///< of twice the areas
};

}  // namespace

SurfacePoints sample_surface(Points vertices, Triangles faces, std::size_t count, const SamplingOptions& options) {
    require(count > 0 && count <= most_points, "sample_surface", "count", count,
            "be from 1 to " + std::to_string(most_points));
    const Sampler sampler(vertices, faces, options.seed);
    switch (options.method) {
        case SamplingMethod::random:
            return sampler.draw(count, false, options.run);
        case SamplingMethod::poisson:
            return sampler.poisson(count, options.run);
        default:
            const SurfacePoints twice = sampler.poisson(2 * count, options.run);
            return rows_of(twice, random_half(2 * count, options.seed));
    }
}

std::vector<double> interpolate(const SurfacePoints& at, Triangles faces, const std::vector<double>& values,
                                std::size_t components) {
    std::vector<double> out(at.count() * components);
    for (std::size_t i = 0; i < at.count(); ++i) {
        const std::int32_t* abc = faces[static_cast<std::size_t>(at.face[i])];
        for (int c = 0; c < 3; ++c) {
            const std::size_t row = static_cast<std::size_t>(abc[c]) * components;
            if (row + components > values.size())
                throw std::invalid_argument("values has " + std::to_string(values.size()) +
                                            " entries, none for vertex " + std::to_string(abc[c]));
            for (std::size_t j = 0; j < components; ++j)
                out[i * components + j] += at.weights[3 * i + static_cast<std::size_t>(c)] * values[row + j];
        }
    }
    return out;
}

std::vector<double> interpolate_normals(const SurfacePoints& at, Triangles faces, const std::vector<double>& normals) {
    std::vector<double> out = interpolate(at, faces, normals, 3);
    for (std::size_t i = 0; i < out.size(); i += 3) store(&out[i], unit(load(&out[i])));
    return out;
}

}  // namespace gaussmap
