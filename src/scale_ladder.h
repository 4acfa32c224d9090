// The ladder of scales for noisy elements (docs/method.md, "Choosing from the data").
#pragma once

#include <cstdint>
#include <vector>

#include "automatic.h"
#include "element_graph.h"

namespace gaussmap {

/// What is tried on every rung: a quadric and a quartic in chords; the quadric's shape operator averaged over half the
/// neighbours it was fitted to, and over all of them; the slopes of the quadrics' normals over the same; on clouds the
/// surface of algebraic spheres, the same over finer samples (fine_spheres.h), and what those extrapolate to.
enum class Family : std::uint8_t {
    quadric,
    half_mean,
    mean,
    half_slope,
    slope,
    quartic,
    sphere,
    fine_sphere,
    extrapolated
};
constexpr int families = 9;
constexpr bool of_spheres(Family family) {
    return family >= Family::sphere;
}
inline bool spheres_tried(const Elements& elements) {
    return !elements.connected;
}
inline int families_tried(const Elements& elements) {
    return spheres_tried(elements) ? families : static_cast<int>(Family::sphere);
}

/// Elements that a rung's fits stand on, from 0 up: threefold in three steps.
int rung_neighbors(int rung);
constexpr int most_rungs = 15;

/// Steps of diffusion over the surface near by.
constexpr int near_reach = 12;

/// The choice that stands for a family on a rung.
constexpr std::uint8_t first_rung_choice = 16;
constexpr std::uint8_t rung_choice(int rung, Family family) {
    return static_cast<std::uint8_t>(first_rung_choice + rung * families + static_cast<int>(family));
}

/// −1 of choices that are none of a rung.
constexpr int rung_of(std::uint8_t choice) {
    return choice < first_rung_choice ? -1 : (choice - first_rung_choice) / families;
}
/// Of the choice of a rung.
constexpr Family family_of(std::uint8_t choice) {
    return static_cast<Family>((choice - first_rung_choice) % families);
}

/// Climb, and put into `result` whatever promises a smaller error than what is there.
/// \param active  elements to begin with; others are left alone.
/// \param length  as much as lengths are scaled by.
void climb(const Elements& elements, double scale, const ElementGraph& graph, std::vector<std::uint8_t> active,
           AutomaticCurvature& result, const Execution& run);

}  // namespace gaussmap
