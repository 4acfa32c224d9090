// The Delaunay fan of one point among its neighbours, projected onto its tangent plane.
#pragma once

#include <cstdint>
#include <vector>

#include "neighborhood.h"
#include "vec.h"

namespace gaussmap {

/// Neighbours seen in the tangent plane, a quantity an array, and their order about the centre.
struct Rays {
    std::vector<double> u, v;        ///< the inverted projection, q/|q|²
    std::vector<double> size;        ///< |u| + |v|
    std::vector<double> squared;     ///< |q|² of the projection itself
    std::vector<double> angle;       ///< grows with the polar angle from 0 to 4; beyond for what is passed over
    std::vector<std::int32_t> turn;  ///< slots of the neighbourhood by ascending angle

    explicit Rays(std::size_t k)
        : u(padded(k)), v(u.size()), size(u.size()), squared(u.size()), angle(u.size()), turn(u.size()) {}
};

/// A fan and the room to build it in; reused from point to point.
struct Fan {
    std::vector<std::int32_t> chain;  ///< slots of the neighbourhood, counterclockwise about the normal; triangles
                                      ///< between consecutive ones
    bool closed = false;              ///< and one between the last and the first
    Rays rays;                        ///< scratch

    explicit Fan(std::size_t k) : rays(k) { chain.reserve(k); }
    std::size_t triangles() const { return chain.empty() ? 0 : chain.size() - (closed ? 0 : 1); }
};

/// The triangles incident on the centre in the Delaunay triangulation of the centre and its projected neighbours: the
/// edges, away from 0, of the convex hull of 0 and the inverted neighbours q/|q|² (docs/method.md, eq. (7)).
///
/// The fan does not depend on the order of the neighbours, and turning the normal round reverses it:
/// - neighbours cocircular with the centre (to 1e-12, relative) all stay, so that a square cell counts in full whatever
///   its diagonal; a choice by index would depend on how the points are numbered;
/// - of neighbours in the same direction (to 1e-12) the nearest stays, of equal ones that of the lowest index;
/// - neighbours that project onto the centre (to 1e-12 of the neighbourhood's size) are passed over;
/// - neighbours all on one line through the centre make no fan; a gap of half a turn or more opens it.
/// \param normal  unit, or NaN for no fan.
/// Nothing is allocated. Time O(k²) for up to 64 neighbours, in vectors; O(k log k) beyond.
void build_fan(const Neighborhood& neighborhood, Vec3 normal, Fan& fan);

}  // namespace gaussmap
