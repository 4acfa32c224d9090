// The neighbours of an element as a surface patch: height fields over its tangent plane, in two kinds of coordinates.
#pragma once

#include <algorithm>
#include <cmath>

#include "frame.h"
#include "height_fit.h"
#include "vec.h"

namespace gaussmap {

/// How a neighbour's place in the tangent plane is told.
enum class Chart {
    monge,  ///< by its projection ρ
    chord,  ///< by ρ |d| / |ρ|, d the difference in space: a sphere is then an exact quadric (docs/method.md, eq. (16))
};

/// Where neighbours are seen from.
struct View {
    Vec3 normal;  ///< unit: heights are along it
    Vec3 foot;    ///< the origin, as a difference from the element
    double size;  ///< unit of lengths
};

/// Take in `count` more neighbours, given as differences from the element.
template <int Degree>
Frame collect_more(Moments<Degree>& moments, const Vec3* neighbors, int count, const View& view, Chart chart) {
    const Frame frame = frame_about(view.normal);
    const double unit = 1 / view.size;
    for (int j = 0; j < count; ++j) {
        const Vec3 d = neighbors[j] - view.foot;
        double u = unit * dot(d, frame.u), v = unit * dot(d, frame.v);
        const double height = unit * dot(d, frame.n), flat = u * u + v * v, squared = flat + height * height;
        if (chart == Chart::chord) {
            // Where the surface stands upright the direction is lost: no farther out than four times the projection.
            const double stretch = flat > 0 ? std::min(std::sqrt(squared / flat), 4.0) : 1;
            u *= stretch, v *= stretch;
        }
        moments.add(u, v, height);
    }
    return frame;
}

/// The same from the start; with `self`, the element first.
template <int Degree>
Frame collect(Moments<Degree>& moments, const Vec3* neighbors, int count, bool self, const View& view, Chart chart) {
    constexpr Vec3 element = {};
    moments.clear();
    if (self) collect_more(moments, &element, 1, view, chart);
    return collect_more(moments, neighbors, count, view, chart);
}

/// The view from the fitted surface itself: its foot under the element, its normal.
template <class Coefficients>
void settle(View& view, const Frame& frame, const Coefficients& c) {
    view.foot = view.foot + view.size * c[0] * frame.n;
    view.normal = unit(frame.n - c[1] * frame.u - c[2] * frame.v);
}

}  // namespace gaussmap
