// Two surfaces that the library does not make, for judging on others than those it was developed with.
#pragma once

#include "gaussmap/surfaces.h"

/// Monkey saddle z = amplitude · (x³ − 3xy²) over −1 ≤ x, y ≤ 1, open; flat at the origin, steep at the corners.
gaussmap::Surface monkey_saddle(double amplitude, int around, int across, const gaussmap::SurfaceOptions& options);

/// Rounded cube x⁴ + y⁴ + z⁴ + roundness · (x² + y² + z²) = 1 over the subdivided icosahedron: nearly flat faces,
/// density rising along edges and towards corners.
gaussmap::Surface rounded_cube(double roundness, int subdivisions, const gaussmap::SurfaceOptions& options);
