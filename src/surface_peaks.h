// The greatest distances between two surfaces brought down, one vertex at a time.
#pragma once

#include "face_boxes.h"
#include "surface_fit.h"

namespace gaussmap {

/// While that works, move a vertex of the face on which the greatest distance of all is, in either direction, so that
/// the greatest distance around the vertex falls; until that is of no use.
/// \param centres   as they were fitted.
/// \param vertices  of the fine surface; they are kept up to date.
/// \param fine      the surface that the samples are of.
/// \return the moves.
std::size_t lower_peaks(RingMesh& coarse, const AreaSamples& centres, VertexSamples& vertices, const FaceBoxes& fine,
                        const Execution& run);

}  // namespace gaussmap
