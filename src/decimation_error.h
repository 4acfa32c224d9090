// How far a decimated mesh is from what it was.
#pragma once

#include <vector>

#include "decimation_input.h"
#include "face_boxes.h"
#include "gaussmap/types.h"

namespace gaussmap {

/// Distances over the diagonal of the input, the larger of both ways.
struct DecimationError {
    double max = 0, rms = 0;
};

/// As `surface_distance` measures them with 100,000 samples, but without its index of the input, which would hold more
/// than all of the decimation did.
/// \param fine      boxes of the input's faces.
/// \param vertices  of the result, 3 each, and its faces; in the input's box of diagonal 1. At least one face.
DecimationError decimation_error(const DecimationInput& in, const FaceBoxes& fine, Points vertices, Triangles faces,
                                 const Execution& run);

}  // namespace gaussmap
