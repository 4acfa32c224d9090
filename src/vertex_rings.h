// The neighbours of a mesh's vertices along its edges: other sheets, however near in space, stay out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

/// Vertices joined by an edge of a face, each vertex's in the order of their indices. Any connectivity; faces with a
/// repeated corner or a non-finite one join nothing. Memory 8 bytes a vertex and 24 a face, a third of it for good on
/// closed meshes. Time O(n + m).
class VertexRings {
  public:
    /// \throw std::invalid_argument at an index outside the vertices.
    VertexRings(Points vertices, Triangles faces);

    std::size_t degree(std::size_t vertex) const { return offset_[vertex + 1] - offset_[vertex]; }

    /// Whether faces do not go all the way round the vertex: on borders, and at vertices of no face.
    bool open(std::size_t vertex) const { return open_[vertex] != 0; }

    std::span<const std::int32_t> around(std::size_t vertex) const {
        return {neighbor_.data() + offset_[vertex], degree(vertex)};
    }

    /// What a search needs, used again for the next: a thread's own. A byte a vertex.
    class Room {
        friend class VertexRings;
        struct Met {
            double squared;
            std::int32_t index;
        };
        void begin(std::size_t vertices, std::int32_t vertex);
        void enter(const std::int32_t* around, std::size_t degree);
        void sort(std::size_t from, std::size_t wanted);
        std::vector<std::uint8_t> known_;  ///< whether a vertex is among those met
        std::vector<std::int32_t> met_;    ///< in the order of the rings; as long as was ever needed
        std::size_t met_count_ = 0;
        std::vector<Vec3> rings_;  ///< the first two, as differences
        std::vector<Met> nearest_, unsorted_;
        std::vector<std::uint32_t> ends_;  ///< of buckets
    };

    /// Up to k vertices met on whole rings about the vertex, at least 5/4 k where there are: those of the first ring,
    /// then those of the second, then the nearest of the others; in each part nearest first, ties by index; −1 where
    /// there are fewer. Lengths are such that the two first rings are round: on grids of unlike spacings, and on coarse
    /// tubes, the nearest in space are on few lines. Vertices at its very position are passed through and left out.
    /// Time O(k) where degrees are bounded; rings do not grow through vertices of more than 4 k neighbours.
    void nearest(std::size_t vertex, int k, Room& room, std::int32_t* row) const;

  private:
    void meet(std::size_t vertex, std::size_t enough, std::size_t hub, Room& room, std::size_t (&inner)[2]) const;

    Points vertices_;
    std::vector<std::size_t> offset_;
    std::vector<std::int32_t> neighbor_;  ///< and as many more as are read at once
    std::vector<std::uint8_t> open_;
};

}  // namespace gaussmap
