// Adding up over the faces of a vertex, by several threads, with the bits of the serial loop.
//
// A serial loop adds to each vertex in ascending order of its faces. Cut the faces into one contiguous chunk a thread
// and let each vertex be owned by the first chunk that touches it. The owner adds at once; a later chunk sets its
// contributions to that vertex aside, in order, and they are added when all chunks are done, chunk after chunk. Every
// vertex thus receives its contributions in ascending order of its faces, whatever the number of chunks. On a mesh with
// any locality few contributions are set aside: those along the seams between chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

struct FaceChunks {
    std::vector<std::size_t> begin;  ///< chunk c holds faces begin[c] … begin[c + 1] − 1
    std::vector<std::uint8_t>
        owner;  ///< vertex → first chunk that touches it (the last chunk where none does); empty if one chunk

    std::size_t count() const { return begin.size() - 1; }
};

/// One chunk a thread (at most 255), fewer for small meshes. All chunks but the last have had their faces checked on
/// the way; the last has not been read: whoever walks over it checks each stretch while it is in the cache (check.h).
/// \throw std::invalid_argument at an index outside [0, vertices), in a chunk before the last.
FaceChunks chunk_faces(Triangles faces, std::size_t vertices, const Execution& run);

}  // namespace gaussmap
