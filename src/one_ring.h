// Corrected curvature measures over the one-ring in place of fits, where fits are the likely culprits.
#pragma once

#include "automatic.h"
#include "gaussmap/types.h"
#include "vertex_rings.h"

namespace gaussmap {

/// The choice that stands for the one-ring's corrected measures.
constexpr std::uint8_t one_ring_choice = 3;

/// On grids of great symmetry the errors of the one-ring's measures cancel, and can be smaller than those of fits over
/// wider windows. Takes them where no noise is, they differ from the fits smoothly, and by more than an estimate of
/// their own error explains.
/// \param fitted_normals  those of the fits, on one side of the surface, which tell the differences.
/// \param mesh_normals    those that the measures are then made with: where fits are wrong, so are their normals.
/// \param found           of the vertices; densities are replaced.
void take_one_rings(Points vertices, Triangles faces, const VertexRings& rings, Points fitted_normals,
                    Points mesh_normals, AutomaticCurvature& found, const Execution& run);

}  // namespace gaussmap
