// Level sets of algebraic spheres about four places of a surface at once.
#pragma once

#include <cstdint>
#include <vector>

#include "algebraic_sphere.h"
#include "frame.h"
#include "lane_spheres.h"

namespace gaussmap {

/// A surface by its samples.
using Surface = std::vector<SphereSample>;

/// What of a surface counts for a place.
struct SphereWindow {
    const SphereSample* place = nullptr;    ///< counts too
    const std::int32_t* samples = nullptr;  ///< the others; −1 where there is none
    double radius = 0;
};

/// A level set through a place, in a frame about the place's normal and in units of the window's radius.
struct PlacedLevelSet {
    Frame frame;
    Vec3 middle;  ///< mean place of the samples
    LevelSet at_place;
    Symmetric3 shape;    ///< its shape operator, carried to the place's tangent plane
    bool found = false;  ///< false where samples do not determine it, or where it turns away from the place
};

/// A shape operator of the place's tangent plane, seen like the level set, in space.
inline Symmetric3 in_space(const PlacedLevelSet& seen, const Symmetric3& shape, double radius) {
    const double unit = 1 / radius;
    return in_plane(seen.frame, unit * shape.xx, unit * shape.xy, unit * shape.yy);
}

/// Which samples count.
enum class Count {
    of_one_half,  ///< whose normals are about as expected, and not of the far half of a tube (lane_spheres.h)
    all,          ///< of any normal, turned to the side that is expected
};

/// \param samples  of each window.
void find_level_sets(const Surface& surface, const SphereWindow* windows, int filled, int samples, Count which,
                     PlacedLevelSet (&found)[fit_lanes]);

}  // namespace gaussmap
