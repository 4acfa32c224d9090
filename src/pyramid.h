// A noisy surface, coarser from level to level: groups of near elements become one whose noise is less.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "element_graph.h"
#include "gaussmap/types.h"
#include "shape_tensor.h"
#include "vec.h"

namespace gaussmap {

struct Level {
    static constexpr int group = 3;  ///< elements that one of the next level stands for

    std::vector<double> position;  ///< x y z …
    std::vector<double> foot;      ///< x y z …, where the surface is thought to be under each element
    std::vector<Vec3> normal;      ///< there, unit; not finite where unknown
    ElementGraph graph;
    std::vector<float> area;  ///< how many elements of the lowest level have each one above them, parent by parent
    double members = 1;       ///< elements of the lowest level that one stands for

    std::size_t count() const { return position.size() / 3; }
    Vec3 at(std::size_t i) const { return load(position.data() + 3 * i); }
    Vec3 foot_of(std::size_t i) const { return load(foot.data() + 3 * i); }
};

/// What was measured at the elements of a level.
struct Measured {
    std::vector<double> density;
    std::vector<float>
        risk;  ///< what the density is chosen by: its squared error, feared; infinite where there is none
    std::vector<float> error;         ///< squared, expected
    std::vector<float> noise;         ///< its part by noise
    std::vector<float> disagreement;  ///< weighted variance of what was mixed
    std::vector<float> cut;  ///< variance of the slopes in its window, relative to a disc's: 1, and more beside borders
    std::vector<double> weight;  ///< what all that was mixed counts
    std::vector<Vec3> normal;
    std::vector<Symmetric3> tensor;
    std::vector<std::uint8_t> choice;  ///< of the smallest risk
};

Measured nothing_measured(std::size_t count);

/// A level over another one.
struct CoarserLevel {
    Level level;
    std::vector<std::int32_t> representative;  ///< of each element, the one of the level below at whose foot it is
    std::vector<std::int32_t> parent;          ///< of each element of the level below, the nearest of this one
    Measured measured;
};

/// Each group of three along a space-filling curve becomes an element over the foot of its middle member, at the mean
/// of its members' heights over their feet: curvature does not lower it, and noise is averaged.
/// \param grouping  0, 1 or 2: elements that the first group has less.
/// \return          of which nothing is measured yet.
CoarserLevel coarsened(const Level& level, int grouping, const Execution& run);

/// What a fit makes of an element.
struct Estimate {
    double density;
    float risk, error, noise, disagreement, cut;  ///< as of `Measured`
    Vec3 normal;
    Symmetric3 tensor;
    std::uint8_t choice;
};

/// Mix an estimate into what an element has: near the best one several are about as good, and the choice among them is
/// noise. A weight of 0 changes nothing.
void mix(const Estimate& estimate, double weight, std::size_t i, Measured& measured);

/// Mix what coarser levels, one for each grouping, know into the elements of a level, interpolated between feet. All of
/// them count alike: which one promises less is chance.
void refine(const std::vector<CoarserLevel>& groupings, const Level& level, Measured& fine, const Execution& run);

/// Give elements that know far worse than a neighbour that lends what that one knows, interpolated likewise.
void borrow(const Level& level, const std::vector<std::uint8_t>& lends, Measured& measured, const Execution& run);

}  // namespace gaussmap
