// From space to the picture: which side is looked at, and where on the picture things fall.
#pragma once

#include <vector>

#include "gaussmap/picture.h"
#include "vec.h"

namespace gaussmap {

/// Axes of the picture in space, orthonormal.
struct View {
    Vec3 right, up, toward;  ///< toward the eye
};

/// A rectangle of pixels.
struct Viewport {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Orthographic: pixels from the viewport's corner, x to the right, y down, z (pixels too) toward the eye.
struct Projection {
    View view;
    Vec3 centre;          ///< of the box, taken away first: a far origin costs no accuracy
    double scale = 1;     ///< pixels a length
    double x = 0, y = 0;  ///< pixel of the centre

    Vec3 operator()(Vec3 p) const {
        const Vec3 d = p - centre;
        return {x + scale * dot(view.right, d), y - scale * dot(view.up, d), scale * dot(view.toward, d)};
    }
    /// A direction, not scaled.
    Vec3 turn(Vec3 n) const { return {dot(view.right, n), -dot(view.up, n), dot(view.toward, n)}; }
};

/// The views asked for, of an object whose box has these sides.
/// \throw std::invalid_argument on a direction or an upward direction that is not finite, or if they are parallel.
std::vector<View> views_of(Vec3 sides, const PictureOptions& options);

/// A rectangle on a view's plane, and what `fit` works on: the extent of what is drawn about the centre.
struct Extent {
    double left = 0, right = 0, bottom = 0, top = 0;
};

/// Each view in its viewport, all at the one scale at which all fit.
std::vector<Projection> fit(const std::vector<View>& views, const std::vector<Extent>& extents, Vec3 centre,
                            const std::vector<Viewport>& viewports);

}  // namespace gaussmap
