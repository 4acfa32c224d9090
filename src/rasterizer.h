// Triangles and discs to pixels: depth buffer, four samples a pixel, shading.
#pragma once

#include <vector>

#include "camera.h"
#include "colormap.h"
#include "gaussmap/picture.h"

namespace gaussmap {

/// What is drawn. Triangles where there are faces, else a disc a point.
struct Scene {
    Points vertices;
    Triangles faces;
    const std::vector<double>& values;   ///< a vertex
    const std::vector<double>& normals;  ///< 3 a vertex, unit, NaN where undefined; or empty
    const std::vector<double>& radii;    ///< of the discs, 0: not drawn; empty for triangles
};

/// Draw into the viewport, over white. Bands of rows are drawn side by side; in each, triangles and discs come in their
/// order and the first of those at one same depth stays, so the bytes do not depend on the number of threads.
void render(const Scene& scene, const Ramp& ramp, const Projection& projection, const Viewport& viewport,
            Picture& picture, const Execution& run);

}  // namespace gaussmap
