#include "camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace gaussmap {
namespace {

constexpr Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

Vec3 unit(Vec3 a) {
    return (1 / length(a)) * a;
}

bool is_zero(Vec3 a) {
    return a.x == 0 && a.y == 0 && a.z == 0;
}

/// A vector of an option, scaled to length 1 whatever its length; zero stays zero.
Vec3 option_vector(const std::array<double, 3>& value, const char* name) {
    const Vec3 v = load(value.data());
    if (!finite(v)) throw std::invalid_argument(std::string("draw: ") + name + " is not finite");
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (largest == 0) return v;
    return unit({v.x / largest, v.y / largest, v.z / largest});
}

struct Gaze {
    Vec3 toward, up;
};

/// The shortest side toward the eye, so that the long ones lie across; of these the later one upward, which is right
/// for models that stand on y and for scans that stand on z. From there a little to the right and from above.
Gaze automatic(Vec3 sides) {
    const double s[3] = {sides.x, sides.y, sides.z};
    const double longest = std::max({s[0], s[1], s[2]});
    int depth = 2;
    for (int axis : {1, 0})
        if (s[axis] < 0.99 * s[depth]) depth = axis;
    const int across = depth == 0 ? 1 : 0, upward = depth == 2 ? 1 : 2;
    // Flat and lying: a relief or a terrain, seen from the south.
    if (depth == 2 && s[2] < 0.2 * longest) return {{0.25, -0.75, 0.9}, axes[2]};
    const Vec3 front = cross(axes[across], axes[upward]);
    return {front + 0.5 * axes[across] + 0.42 * axes[upward], axes[upward]};
}

View look(Gaze gaze) {
    const Vec3 toward = unit(gaze.toward);
    const Vec3 right = unit(cross(gaze.up, toward));
    return {right, cross(toward, right), toward};
}

Vec3 quarter_turn(Vec3 v, Vec3 about) {
    return cross(about, v) + dot(about, v) * about;
}

}  // namespace

std::vector<View> views_of(Vec3 sides, const PictureOptions& options) {
    const Vec3 direction = option_vector(options.direction, "direction"), up = option_vector(options.up, "up");
    const auto parallel = [](Vec3 a, Vec3 b) { return squared(cross(a, b)) < 1e-12 * squared(a); };
    Gaze gaze = automatic(sides);
    if (!is_zero(direction)) gaze.toward = direction;
    if (!is_zero(up)) {
        if (!is_zero(direction) && parallel(direction, up))
            throw std::invalid_argument("draw: direction and up are parallel; give another up");
        gaze.up = up;
    }
    if (parallel(gaze.toward, gaze.up)) {
        // One of the two was chosen here: a direction that fits the other.
        Vec3& free = is_zero(up) ? gaze.up : gaze.toward;
        const Vec3 fixed = is_zero(up) ? gaze.toward : gaze.up;
        free = std::abs(fixed.y) < 0.7 * length(fixed) ? axes[1] : axes[0];
    }
    std::vector<View> views;
    for (int i = 0; i < options.views; ++i) {
        views.push_back(look(gaze));
        gaze.toward = quarter_turn(gaze.toward, gaze.up);
    }
    return views;
}

std::vector<Projection> fit(const std::vector<View>& views, const std::vector<Extent>& extents, Vec3 centre,
                            const std::vector<Viewport>& viewports) {
    constexpr double filled = 0.9;  // of each side of the viewport
    double scale = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < views.size(); ++i) {
        scale = std::min(scale, filled * viewports[i].width / (extents[i].right - extents[i].left));
        scale = std::min(scale, filled * viewports[i].height / (extents[i].top - extents[i].bottom));
    }
    if (!std::isfinite(scale)) scale = 1;  // a single point
    std::vector<Projection> out;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const Extent& e = extents[i];
        out.push_back({views[i], centre, scale, 0.5 * viewports[i].width - scale * 0.5 * (e.left + e.right),
                       0.5 * viewports[i].height + scale * 0.5 * (e.bottom + e.top)});
    }
    return out;
}

}  // namespace gaussmap
