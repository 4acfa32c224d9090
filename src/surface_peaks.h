// The greatest distances between two surfaces brought down, one vertex at a time.
#pragma once

#include "gaussmap/distance.h"
#include "surface_fit.h"

namespace gaussmap {

/// While that works, move a vertex of the face on which the greatest distance of all is, in either direction, so that
/// the greatest distance around the vertex falls. \param fine  the surface that the samples are of. \return the moves.
std::size_t lower_peaks(RingMesh& coarse, FitSamples& samples, const ClosestIndex& fine, std::size_t most_steps,
                        const Execution& run);

}  // namespace gaussmap
