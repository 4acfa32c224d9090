// A triangle mesh that changes: collapses and flips, on any connectivity.
//
// The corners of a vertex are a circular list through one array, so that two rings join by exchanging links and nothing
// is ever allocated. A side is known by the corner opposite to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/types.h"
#include "vec.h"

namespace gaussmap {

/// How freely a vertex moves. Tagged sides are borders, seams, features, and sides that are not manifold.
enum class VertexKind : std::uint8_t {
    free,   ///< on no tagged side
    curve,  ///< where two tagged sides meet: it moves along them
    corner  ///< anything else: it stays
};

enum class Refusal : std::uint8_t { none, locked, topology, folding };

class RingMesh {
  public:
    /// Faces are usable: indices within the vertices, no corner repeated.
    RingMesh(std::vector<Vec3> positions, std::vector<std::int32_t> corners);

    std::vector<Vec3> position;
    std::vector<std::int32_t> vertex;  ///< of corner 3f + k of face f; −1 where the face has gone
    std::vector<std::int32_t> first;   ///< a corner of each vertex; −1: none
    std::vector<VertexKind> kind;
    std::vector<std::int32_t> origin;  ///< of each face: the first face that it descends from
    std::vector<std::uint8_t> tags;    ///< a face: bit k: the side opposite corner k is tagged

    std::size_t face_count() const { return faces_; }
    bool tagged(std::int32_t corner) const { return tags[static_cast<std::size_t>(corner) / 3] >> (corner % 3) & 1; }
    void tag(std::int32_t corner) {
        tags[static_cast<std::size_t>(corner) / 3] |= static_cast<std::uint8_t>(1 << corner % 3);
    }
    static std::int32_t after(std::int32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static std::int32_t before(std::int32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
    std::int32_t next(std::int32_t corner) const { return next_[static_cast<std::size_t>(corner)]; }

    /// Call body(corner) for the corners of a vertex; the mesh must not change meanwhile.
    template <class Body>
    void for_corners(std::int32_t v, Body&& body) const {
        const std::int32_t start = first[static_cast<std::size_t>(v)];
        if (start < 0) return;
        std::int32_t c = start;
        do {
            body(c);
            c = next_[static_cast<std::size_t>(c)];
        } while (c != start);
    }
    /// Call body(w) for the vertices joined to v, each once.
    template <class Body>
    void for_neighbors(std::int32_t v, Body&& body) {
        const std::uint32_t mark = new_marks(1);
        for_corners(v, [&](std::int32_t c) {
            for (const std::int32_t other : {vertex[after(c)], vertex[before(c)]})
                if (mark_[other] != mark) mark_[other] = mark, body(other);
        });
    }

    /// Tag sides of one face, of three and more, and of two that run the same way.
    void tag_irregular_sides();
    /// Tag sides whose faces' normals differ by more than this.
    void tag_features(double cosine);
    /// The kinds, from the tags and from how many fans a vertex has. After `tag_irregular_sides`, which tells the plain
    /// vertices from those that need a closer look.
    void find_kinds();

    /// The corner of a face at a vertex, and the ends of the two sides there.
    struct Sector {
        std::int32_t corner, from, to;
    };
    /// Room that stays. Without a branch on whether an entry is kept, of which no processor could guess half.
    class Sectors {
      public:
        void clear() { count_ = 0; }
        void add(const Sector& s, bool kept = true) {
            if (count_ == room_.size()) room_.resize(2 * count_);
            room_[count_] = s;
            count_ += kept;
        }
        std::size_t size() const { return count_; }
        const Sector* begin() const { return room_.data(); }
        const Sector* end() const { return begin() + count_; }

      private:
        std::vector<Sector> room_ = std::vector<Sector>(16);
        std::size_t count_ = 0;
    };
    void gather(std::int32_t v, Sectors& sectors) const;
    /// The faces around both ends of an edge, as they were when it was looked at.
    struct Edge {
        std::int32_t a, b;
        Sectors of_a, of_b;  ///< of one of them alone
        Sectors shared;      ///< of both, seen from a
    };
    void look(std::int32_t a, std::int32_t b, Edge& edge) const;
    /// Why the ends may not become one vertex, wherever it is put.
    /// Link condition: Dey, Edelsbrunner, Guha, Nekhayev, "Topology Preserving Edge Contraction", 1999.
    Refusal refusal(const Edge& edge, bool allow_topology);
    /// Would a face turn over, or become a sliver, with both ends at p?
    bool folds(const Edge& edge, Vec3 p) const;
    /// b joins a at p; the faces on both go.
    void collapse(const Edge& edge, Vec3 p);
    /// Would a face of v turn over, or become a sliver, with v at p?
    bool folds(std::int32_t v, Vec3 p);
    /// Vertices and faces that have gone give up their places; the order stays.
    /// \return the new number of each vertex, −1 of those that have gone.
    std::vector<std::int32_t> close_gaps();

    /// The only other corner opposite to the same side, −1 unless there is exactly one and it runs the other way.
    std::int32_t twin(std::int32_t corner) const;
    /// The side opposite to the corner is replaced by the other diagonal of its two faces.
    void flip(std::int32_t corner, std::int32_t twin);

  private:
    std::uint32_t new_marks(std::uint32_t count);
    void link_all();
    bool closed_fan(std::int32_t v, std::vector<std::int32_t>& follower);
    Refusal free_refusal(const Edge& edge);
    bool turns(std::int32_t v, const Sectors& sectors, Vec3 p) const;
    struct SharedFace {
        std::int32_t of_b, third;  ///< corners
    };
    static SharedFace shared_face(const Edge& edge, const Sector& s);
    void unlink(std::int32_t corner);
    void link(std::int32_t corner, std::int32_t v);
    bool all_in_one_fan() const;
    std::size_t parts() const;
    VertexKind kind_of(std::int32_t v);

    std::vector<std::int32_t> next_;
    std::vector<std::uint32_t> mark_;
    Sectors sectors_;  ///< of the vertex last gathered
    std::uint32_t marks_ = 0;
    std::size_t faces_ = 0;
};

constexpr double least_cosine = 0.25;  ///< between a face's normals before and after a step
constexpr double sliver = 2e-3;        ///< 2 area / Σ edge² below which a face is one; 0.289 is equilateral

/// Whether a triangle that was (a, b, c) and becomes (a2, b2, c2) turns by more than some 75°, or becomes a sliver.
bool turns_over(Vec3 a, Vec3 b, Vec3 c, Vec3 a2, Vec3 b2, Vec3 c2);

}  // namespace gaussmap
