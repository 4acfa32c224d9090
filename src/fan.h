// The Delaunay fan of one point among its neighbours, projected onto its tangent plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lane_neighborhoods.h"
#include "neighborhood.h"
#include "vec.h"

namespace gaussmap {

/// A neighbour seen in the tangent plane.
struct Ray {
    double u, v;        ///< the inverted projection, q/|q|²
    double size;        ///< |u| + |v|
    double squared;     ///< |q|² of the projection itself
    double angle;       ///< grows with the polar angle, from 0 to 4
    std::int32_t slot;  ///< of the neighbourhood
};

/// A fan and the room to build it in; reused from point to point.
struct Fan {
    std::vector<std::int32_t> chain;  ///< its first `corners` entries: slots of the neighbourhood, counterclockwise
                                      ///< about the normal; triangles between consecutive ones
    std::size_t corners = 0;
    bool closed = false;             ///< and a triangle between the last and the first
    std::vector<Ray> rays, turns;    ///< scratch: by slot and by angle
    std::vector<std::int32_t> keys;  ///< scratch: what they are sorted by

    explicit Fan(std::size_t k) : chain(k), rays(padded(k)), turns(rays.size()), keys(rays.size()) {}
    std::size_t triangles() const { return corners == 0 ? 0 : corners - (closed ? 0 : 1); }
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
/// Nothing is allocated. Where the twelve first neighbours make a closed fan that no other can reach into, it is all
/// there is to it; else time O(k²) for up to 64 neighbours, in vectors, and O(k log k) beyond.
void build_fan(const Neighborhood& neighborhood, Vec3 normal, Fan& fan);

/// The same fans of the points of `around`, mostly side by side, in a fraction of the time: those that are closed and
/// hang on nothing near the tolerances.
void build_fans(LaneNeighborhoods& around, std::span<const Vec3> normals, std::span<Fan> fans);

}  // namespace gaussmap
