// Boxes about short runs of faces that are in an order of space: a tree that costs a few bytes a face and hardly any
// time to make, for searches that begin near their end. `ClosestIndex` is the one for many queries from anywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

/// levels[0] holds the boxes of four faces each, eight to a node; levels[l] those of the nodes of levels[l − 1], the
/// last of them in one node. Single precision, widened by more than its rounding.
struct FaceBoxes {
    struct alignas(32) Node {
        float low[3][8], high[3][8];
    };
    const std::vector<Vec3>& positions;
    const std::vector<std::int32_t>& corners;
    std::vector<std::vector<Node>> levels;
};

/// \param positions, corners  what outlives the boxes; coordinates within [−1, 1], faces in an order of space.
/// Time O(faces), memory 7 bytes a face.
FaceBoxes face_boxes(const std::vector<Vec3>& positions, const std::vector<std::int32_t>& corners,
                     const Execution& run);

struct FaceHit {
    double squared = std::numeric_limits<double>::infinity();  ///< distance
    std::int32_t face = -1;
};

/// The squared distance of q from one face; of face −1 infinite.
FaceHit hit_of(const FaceBoxes& boxes, std::int32_t face, Vec3 q);

/// The face closest to q, or `start` where none is closer; any face within √enough of q will do, if there is one.
FaceHit closest_face(const FaceBoxes& boxes, Vec3 q, FaceHit start = {}, double enough = 0);

}  // namespace gaussmap
