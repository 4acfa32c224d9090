// What the estimators that fit something work on, whether points of a cloud or vertices of a mesh, and what they find.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "eigen3.h"
#include "gaussmap/types.h"
#include "neighborhood.h"
#include "parallel.h"
#include "vec.h"

namespace gaussmap {

/// Elements of a surface.
struct Elements {
    std::size_t count = 0;
    std::function<Vec3(std::size_t)> position;
    /// For elements [first, last): up to k others each, nearest first, −1 where there are fewer; rows of k. Called from
    /// several threads at once; unless `connected`, with blocks that begin at multiples of `block`.
    std::function<void(std::size_t first, std::size_t last, int k, std::int32_t* rows)> neighbors;
    static constexpr std::size_t block = 256;
    /// Neighbours are told by faces, which see through to no other sheet; else by distances in space.
    bool connected = false;

    Vec3 operator[](std::size_t i) const { return position(i); }
};

/// What was measured at each element, in the elements' unit of length.
struct FittedCurvature {
    std::vector<double> density;       ///< 1/length²; NaN where undefined
    std::vector<double> error;         ///< its standard error, 1/length²; NaN where nothing tells it
    std::vector<Vec3> normal;          ///< unit, of arbitrary sign; NaN where undefined
    std::vector<Symmetric3> tensor;    ///< the shape operator, signed by the normal
    std::vector<std::uint8_t> choice;  ///< as `choice_name` tells; empty where there is no choice
    std::size_t lowered = 0;           ///< elements with too few neighbours for what was asked
};

/// Call body(i, neighbourhood) for every element, with its up to k neighbours. Each block of elements has a body of its
/// own, made by make_body(block).
template <class MakeBody>
void for_neighborhoods(const Elements& elements, int k, const Execution& run, MakeBody&& make_body) {
    const auto stride = static_cast<std::size_t>(k);
    for_blocks(elements.count, Elements::block, run, [&](std::size_t block, std::size_t first, std::size_t last) {
        std::vector<std::int32_t> rows((last - first) * stride);
        elements.neighbors(first, last, k, rows.data());
        Neighborhood around(stride);
        auto body = make_body(block);
        for (std::size_t i = first; i < last; ++i) {
            around.gather(elements, i, rows.data() + (i - first) * stride, stride);
            body(i, around);
        }
    });
}

}  // namespace gaussmap
