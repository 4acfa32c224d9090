// The Delaunay fan of one point among its neighbours, projected onto its tangent plane.
#pragma once

#include <cstdint>
#include <vector>

#include "neighborhood.h"
#include "vec.h"

namespace gaussmap {

/// A neighbour seen in the tangent plane.
struct Ray {
    double u, v, squared;  ///< the projection and its squared length
    std::int32_t slot;     ///< of the neighbourhood
    std::int32_t index;    ///< of the point
};

/// A fan and the room to build it in; reused from point to point.
struct Fan {
    std::vector<Ray> chain;  ///< counterclockwise about the normal; triangles between consecutive ones
    bool closed = false;     ///< and one between the last and the first

    struct Turn {
        double angle;
        std::int32_t ray;
    };
    std::vector<Ray> rays;    ///< scratch: all neighbours
    std::vector<Turn> turns;  ///< scratch: rays by angle

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
void build_fan(const Neighborhood& neighborhood, Vec3 normal, Fan& fan);

}  // namespace gaussmap
