// The estimator that chooses for itself, on elements whose neighbours are told by a function: points of a cloud by
// their nearest others, vertices of a mesh by their rings (docs/method.md, "Choosing from the data").
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "eigen3.h"
#include "element_graph.h"
#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

/// Elements of a surface.
struct Elements {
    std::size_t count = 0;
    std::function<Vec3(std::size_t)> position;
    /// For elements [first, last): up to k others each, nearest first, −1 where there are fewer; rows of k. Called from
    /// several threads at once, with blocks that begin at multiples of `block`.
    std::function<void(std::size_t first, std::size_t last, int k, std::int32_t* rows)> neighbors;
    static constexpr std::size_t block = 256;
};

/// What was measured at each element, in the elements' unit of length.
struct AutomaticCurvature {
    std::vector<double> density;       ///< 1/length²; NaN where undefined
    std::vector<double> error;         ///< its standard error, 1/length²
    std::vector<Vec3> normal;          ///< unit, of arbitrary sign; NaN where undefined
    std::vector<Symmetric3> tensor;    ///< the shape operator, signed by the normal
    std::vector<std::uint8_t> choice;  ///< as `choice_name` tells
    ElementGraph graph;                ///< of the elements, for averages over the surface
    double unit = 1;                   ///< about an edge's squared length, a power of 4
    std::size_t lowered = 0;           ///< elements with too few neighbours for a quartic
};

/// \param size  the diagonal of the elements' box, positive and finite.
/// The same bits for any number of threads. Time O(n) fits of at least 24 neighbours; more only where there is noise.
AutomaticCurvature automatic_curvature(const Elements& elements, double size, const Execution& run);

}  // namespace gaussmap
