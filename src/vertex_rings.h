// The neighbours of a mesh's vertices along its edges: other sheets, however near in space, stay out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"

namespace gaussmap {

/// Vertices joined by an edge of a face, each vertex's in the order of their indices. Any connectivity; faces with a
/// repeated corner or a non-finite one join nothing. Memory 8 bytes a vertex and 24 a face, a third of it for good on
/// closed meshes. Time O(n + m).
class VertexRings {
  public:
    /// \throw std::invalid_argument at an index outside the vertices.
    VertexRings(Points vertices, Triangles faces);

    std::size_t degree(std::size_t vertex) const { return offset_[vertex + 1] - offset_[vertex]; }

    /// What a search needs, used again for the next: a thread's own.
    class Room {
        friend class VertexRings;
        struct Met {
            double squared;
            std::int32_t index;
        };
        bool enter(std::int32_t vertex);
        void begin(std::size_t slots);
        std::vector<std::uint64_t> slots_;  ///< open addressing: the search's number, then the vertex
        std::vector<std::int32_t> met_;     ///< in the order of the rings
        std::vector<Met> nearest_;
        std::uint32_t search_ = 0;
    };

    /// The k nearest of at least 3/2 k vertices met on whole rings about the vertex, nearest first, ties by index, −1
    /// where there are fewer; lengths are such that the two first rings are round. Vertices at its very position are
    /// passed through and left out. Time O(k log k) where degrees are bounded; rings do not grow through vertices of
    /// more than 4 k neighbours.
    void nearest(std::size_t vertex, int k, Room& room, std::int32_t* row) const;

  private:
    Points vertices_;
    std::vector<std::size_t> offset_;
    std::vector<std::int32_t> neighbor_;
};

}  // namespace gaussmap
