#include "level_sets.h"

#include "instruction_sets.h"

namespace gaussmap {
namespace {

LaneSphereKernel* best_lane_spheres() {
    return GAUSSMAP_FASTEST(lane_spheres);
}

}  // namespace

void find_level_sets(const Surface& surface, const SphereWindow* windows, int filled, int samples, Count which,
                     PlacedLevelSet (&found)[fit_lanes]) {
    constexpr Vec3 up = {0, 0, 1};
    LaneBalls balls;
    balls.count = samples;
    if (which == Count::all) balls.least_expected = 0, balls.least_cosine = -1;
    for (int l = 0; l < filled; ++l) {
        const SphereWindow& window = windows[l];
        found[l].frame = frame_about(load(window.place->normal));
        balls.set(l, found[l].frame, load(window.place->foot));
        balls.radius[l] = window.radius;
        balls.samples[l] = window.samples;
    }
    LaneSpheres spheres;
    best_lane_spheres()(surface.data(), balls, spheres);
    for (int l = 0; l < filled; ++l) {
        SphereSums sums = spheres.sums(l);
        sums.add({0, 0, 0}, up, windows[l].place->weight);
        found[l].middle = sums.middle();
        found[l].at_place = sums.level_set();
        found[l].found = found[l].at_place.normal.z > one_sheet;
        if (found[l].found) found[l].shape = carried(found[l].at_place.tensor, found[l].at_place.normal, up);
    }
}

}  // namespace gaussmap
