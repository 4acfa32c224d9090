// Corrected curvature measures over the one-ring in place of fits, where fits are the likely culprits.
#pragma once

#include "automatic.h"
#include "gaussmap/types.h"

namespace gaussmap {

/// The choice that stands for the one-ring's corrected measures.
constexpr std::uint8_t one_ring_choice = 3;

/// On grids of great symmetry the errors of the one-ring's measures cancel, and can be smaller than those of fits over
/// wider windows. Takes them where no noise is, and they differ from the fits smoothly and by less than the fits' own
/// estimated error.
/// \param unit_normals  those of the fits, on one side of the surface.
/// \param found  of the vertices; densities and errors are replaced.
void take_one_rings(Points vertices, Triangles faces, Points unit_normals, AutomaticCurvature& found,
                    const Execution& run);

}  // namespace gaussmap
