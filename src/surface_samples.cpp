#include "surface_samples.h"

#include <algorithm>
#include <cmath>

#include "parallel.h"
#include "random.h"

namespace gaussmap {
namespace {

constexpr std::size_t block = std::size_t{1} << 14;

Vec3 corner(Points vertices, Triangles faces, std::size_t face, std::size_t c) {
    return load(vertices[static_cast<std::size_t>(faces[face][c % 3])]);
}

/// Ends of items laid end to end.
template <class Size>
std::vector<double> laid_out(std::size_t count, Size&& size) {
    std::vector<double> ends(count);
    double end = 0;
    for (std::size_t i = 0; i < count; ++i) ends[i] = end += size(i);
    return ends;
}

/// Call visit(step, item, fraction within the item) at `count` equal steps along items laid end to end.
template <class Visit>
void at_equal_steps(const std::vector<double>& ends, std::size_t count, double offset, const Execution& run,
                    Visit&& visit) {
    const double step = ends.back() / static_cast<double>(count);
    for_blocks(count, block, run, [&](std::size_t, std::size_t i, std::size_t last) {
        const auto place = [&](std::size_t s) { return (static_cast<double>(s) + offset) * step; };
        auto item = static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), place(i)) - ends.begin());
        for (; i < last; ++i) {
            while (item + 1 < ends.size() && ends[item] <= place(i)) ++item;
            item = std::min(item, ends.size() - 1);
            const double begin = item == 0 ? 0 : ends[item - 1], size = ends[item] - begin;
            visit(i, item, size > 0 ? std::clamp((place(i) - begin) / size, 0.0, 1.0) : 0.5);
        }
    });
}

std::vector<std::uint8_t> used_vertices(Points vertices, Triangles faces) {
    std::vector<std::uint8_t> used(vertices.count, faces.empty());
    for (std::size_t i = 0; i < 3 * faces.count; ++i) used[static_cast<std::size_t>(faces.abc[i])] = 1;
    return used;
}

}  // namespace

SquarePoint spread_out(std::uint64_t step, std::uint64_t shift) {
    // 2⁶⁴ over the plastic number and its square
    const std::uint64_t u = shift + step * 0xc13fa9a902a6328f, v = mixed(shift) + step * 0x91e10da5c79e7b1c;
    return {static_cast<double>(u >> 11) * 0x1p-53, static_cast<double>(v >> 11) * 0x1p-53};
}

std::vector<double> area_ends(Points vertices, Triangles faces) {
    return laid_out(faces.count, [&](std::size_t f) {
        const Vec3 a = corner(vertices, faces, f, 0);
        return length(cross(corner(vertices, faces, f, 1) - a, corner(vertices, faces, f, 2) - a));
    });
}

SurfaceSamples surface_samples(Points vertices, Triangles faces, std::size_t samples, std::uint64_t seed,
                               const Execution& run) {
    SurfaceSamples made;
    const std::vector<std::uint8_t> used = used_vertices(vertices, faces);
    for (std::size_t v = 0; v < vertices.count; ++v)
        if (used[v]) made.points.insert(made.points.end(), vertices[v], vertices[v] + 3);
    made.counts.vertices = made.points.size() / 3;
    if (faces.empty() || samples == 0) return made;

    const std::vector<double> lengths = laid_out(3 * faces.count, [&](std::size_t i) {
        return length(corner(vertices, faces, i / 3, i + 1) - corner(vertices, faces, i / 3, i));
    });
    const std::vector<double> areas = area_ends(vertices, faces);
    made.counts.edges = lengths.back() > 0 ? (samples + 3) / 4 : 0;
    made.counts.faces = areas.back() > 0 ? samples : 0;
    const std::size_t first_on_edges = made.counts.vertices, first_on_faces = first_on_edges + made.counts.edges;
    made.points.resize(3 * (first_on_faces + made.counts.faces));
    Random random(seed);
    const double offset = random.uniform();
    const std::uint64_t shift = random.next();
    if (made.counts.edges > 0)
        at_equal_steps(lengths, made.counts.edges, offset, part_of(run, 0, 0.3),
                       [&](std::size_t i, std::size_t side, double along) {
                           const Vec3 a = corner(vertices, faces, side / 3, side % 3),
                                      b = corner(vertices, faces, side / 3, side % 3 + 1);
                           store(made.points.data() + 3 * (first_on_edges + i), a + along * (b - a));
                       });
    if (made.counts.faces > 0)
        at_equal_steps(areas, made.counts.faces, offset, part_of(run, 0.3, 1),
                       [&](std::size_t i, std::size_t face, double) {
                           store(made.points.data() + 3 * (first_on_faces + i),
                                 in_triangle(corner(vertices, faces, face, 0), corner(vertices, faces, face, 1),
                                             corner(vertices, faces, face, 2), folded(spread_out(i, shift))));
                       });
    return made;
}

Deviation deviation_of(const std::vector<double>& distance, const SampleCounts& counts) {
    const std::size_t first = counts.faces > 0   ? counts.vertices + counts.edges
                              : counts.edges > 0 ? counts.vertices
                                                 : 0;
    Deviation deviation;
    for (const double d : distance) deviation.max = std::max(deviation.max, d);
    // Added up as a tree would, so that a million small terms lose nothing.
    constexpr std::size_t block = 1024;
    double sum = 0, squares = 0;
    for (std::size_t i = first; i < distance.size();) {
        double part = 0, part_squares = 0;
        for (const std::size_t end = std::min(distance.size(), i + block); i < end; ++i)
            part += distance[i], part_squares += distance[i] * distance[i];
        sum += part, squares += part_squares;
    }
    const auto count = static_cast<double>(distance.size() - first);
    deviation.mean = sum / count;
    deviation.rms = std::sqrt(squares / count);
    return deviation;
}

}  // namespace gaussmap
