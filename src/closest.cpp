// Closest points of surfaces and clouds: queries in the order of a space-filling curve, in blocks that do not depend on
// the number of threads, each block by the best kernel for the machine (closest_search.h).
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "check.h"
#include "check_cloud.h"
#include "closest_tree.h"
#include "instruction_sets.h"
#include "parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t block = 2048;

ClosestKernel best_kernel() {
    return GAUSSMAP_FASTEST(closest_kernel);
}

void check_queries(Points queries) {
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (queries.count > most)
        throw std::invalid_argument("queries has " + std::to_string(queries.count) + " entries, more than " +
                                    std::to_string(most) + "; split them");
    for (std::size_t i = 0; i < queries.count; ++i)
        if (!finite(load(queries[i])))
            throw std::invalid_argument("queries[" + std::to_string(i) +
                                        "] is not finite; leave such points out first");
}

void find_in_triangles(const TriangleTree& tree, Points queries, ClosestKernel kernel, double* squared,
                       std::uint32_t* slot, const Execution& run) {
    std::vector<const Boxes*> levels;
    for (const auto& level : tree.levels) levels.push_back(level.data());
    const ClosestRoom room{tree.leaves.data(), levels.data(), static_cast<int>(levels.size()), queries.xyz};
    const std::vector<std::int32_t> order = spatial_order(queries, part_of(run, 0, 0.1));
    for_blocks(queries.count, block, part_of(run, 0.1, 1), [&](std::size_t, std::size_t begin, std::size_t end) {
        kernel(room, order.data() + begin, end - begin, squared, slot);
    });
}

}  // namespace

void check_surface(Points vertices, Triangles faces) {
    if (vertices.empty()) throw std::invalid_argument("vertices is empty; a surface or a cloud needs some");
    check_faces(faces, vertices.count);
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (faces.count > most)
        throw std::invalid_argument("faces has " + std::to_string(faces.count) + " entries, more than " +
                                    std::to_string(most) + "; split the surface");
    const auto refuse = [](std::size_t v, const std::string& where) {
        throw std::invalid_argument("vertices[" + std::to_string(v) + "]" + where +
                                    " is not finite; leave it out first");
    };
    for (std::size_t i = 0; i < 3 * faces.count; ++i)
        if (const auto v = static_cast<std::size_t>(faces.abc[i]); !finite(load(vertices[v])))
            refuse(v, ", of faces[" + std::to_string(i / 3) + "],");
    if (!faces.empty()) return;
    check_countable(vertices);
    for (std::size_t v = 0; v < vertices.count; ++v)
        if (!finite(load(vertices[v]))) refuse(v, "");
}

double reach(Points vertices, Triangles faces) {
    double most = 0;
    for_surface_points(vertices, faces, [&](Vec3 p) {
        most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    });
    return most;
}

void find_closest(const ClosestTree& tree, Points queries, double* squared, std::uint32_t* slot, const Execution& run) {
    check_queries(queries);
    if (!tree.cloud) return find_in_triangles(tree.triangles, queries, best_kernel(), squared, slot, run);
    const NearestPoints nearest = tree.cloud->nearest(queries, 1, true, run);
    for (std::size_t i = 0; i < queries.count; ++i) {
        squared[i] = nearest.squared_distance[i];
        slot[i] = static_cast<std::uint32_t>(nearest.index[i]);
    }
}

double squared_distance(const ClosestTree& tree, std::uint32_t slot, Vec3 q) {
    if (tree.cloud) return squared(q - load(Points(tree.points)[slot]));
    return closest_offset(tree.triangles, slot, q).squared();
}

ClosestFaces closest_faces(Points vertices, Triangles faces, Points queries, ClosestKernel kernel) {
    const TriangleTree tree = triangle_tree(vertices, faces, {});
    ClosestFaces found{std::vector<double>(queries.count), std::vector<std::int32_t>(queries.count)};
    std::vector<std::uint32_t> slots(queries.count);
    find_in_triangles(tree, queries, kernel, found.squared.data(), slots.data(), {});
    for (std::size_t i = 0; i < queries.count; ++i)
        found.face[i] = tree.leaves[slots[i] / leaf_triangles].face[slots[i] % leaf_triangles];
    return found;
}

ClosestIndex::ClosestIndex(Points vertices, Triangles faces, const Execution& run) {
    check_surface(vertices, faces);
    auto tree = std::make_shared<ClosestTree>();
    tree->reach = reach(vertices, faces);
    if (faces.empty()) {
        tree->points.assign(vertices.xyz, vertices.xyz + 3 * vertices.count);
        tree->cloud = std::make_unique<NeighborIndex>(vertices, run);
    } else {
        tree->triangles = triangle_tree(vertices, faces, run);
    }
    tree_ = std::move(tree);
}

std::vector<double> ClosestIndex::distances(Points queries, const Execution& run) const {
    std::vector<double> distance(queries.count);
    std::vector<std::uint32_t> slot(queries.count);
    find_closest(*tree_, queries, distance.data(), slot.data(), run);
    for (double& d : distance) d = std::sqrt(d);
    return distance;
}

ClosestPoints ClosestIndex::closest(Points queries, const Execution& run) const {
    ClosestPoints found;
    found.distance.resize(queries.count);
    found.points.resize(3 * queries.count);
    found.element.resize(queries.count);
    std::vector<std::uint32_t> slot(queries.count);
    find_closest(*tree_, queries, found.distance.data(), slot.data(), part_of(run, 0, 0.95));
    for_blocks(queries.count, block, part_of(run, 0.95, 1), [&](std::size_t, std::size_t i, std::size_t last) {
        for (; i < last; ++i) {
            found.distance[i] = std::sqrt(found.distance[i]);
            const TriangleTree& triangles = tree_->triangles;
            const Vec3 point = tree_->cloud ? load(Points(tree_->points)[slot[i]])
                                            : closest_point(triangles, slot[i], load(queries[i]));
            store(found.points.data() + 3 * i, point);
            found.element[i] = tree_->cloud ? static_cast<std::int32_t>(slot[i])
                                            : triangles.leaves[slot[i] / leaf_triangles].face[slot[i] % leaf_triangles];
        }
    });
    return found;
}

}  // namespace gaussmap
