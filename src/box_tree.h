// Boxes of eight children, laid out for vector registers: what the trees of points and of triangles share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace gaussmap {

constexpr int children = 8;
constexpr std::int32_t nobody = std::numeric_limits<std::int32_t>::max();

/// The boxes of the children of a node and the lowest index in each; boxes beyond are infinitely far, of nobody.
struct alignas(32) Boxes {
    double low[3][children], high[3][children];
    std::int32_t first[children];
};

/// A node without children.
constexpr Boxes no_boxes() {
    constexpr double far = std::numeric_limits<double>::infinity();
    Boxes boxes{};
    for (int c = 0; c < children; ++c) {
        for (int a = 0; a < 3; ++a) boxes.low[a][c] = far, boxes.high[a][c] = -far;
        boxes.first[c] = nobody;
    }
    return boxes;
}

/// The level above: node i has the boxes of the nodes 8i … 8i + 7 below.
std::vector<Boxes> join(const std::vector<Boxes>& below);

/// A place to be put into a tree, with the index of what is there.
struct Entry {
    double p[3];
    std::int32_t index;
};

/// Part [first, last) into runs of `run` entries (the last may be shorter) at medians of the widest dimension, as in a
/// kd-tree (Friedman, Bentley, Finkel 1977), which makes the boxes of the runs tight. Within a run the order is open.
void part(Entry* first, Entry* last, std::ptrdiff_t run);

}  // namespace gaussmap
