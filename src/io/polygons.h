// Polygons of any size, and triangle strips, become triangles while the polygons themselves are remembered.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/formats.h"

namespace gaussmap::io {

/// Collects the faces of a file in order. Nothing but triangles costs nothing beyond them.
class FaceList {
  public:
    /// Room for as many faces; the caller has checked it against the size of the file.
    void reserve(std::size_t faces);
    /// One face; indices are checked by `finish`. Fewer than 3 corners: counted and dropped (returns false).
    bool add(std::span<const std::int32_t> corners);
    void add_triangle(std::int32_t a, std::int32_t b, std::int32_t c);
    /// Number of faces taken so far.
    std::size_t count() const;
    /// Positions in the file of the faces dropped so far, ascending: what a reader leaves out of their properties.
    const std::vector<std::uint64_t>& dropped() const { return dropped_; }
    /// Check every index against the vertices, triangulate, and hand everything to `geometry` (faces, and polygons with
    /// their maps where a face is no triangle). A face with an index out of range is a FormatError naming face, corner
    /// and value.
    void finish(Geometry& geometry, const Source& source);

  private:
    void check(std::size_t vertices, const Source& source) const;

    std::vector<std::int32_t> corners_;
    std::vector<std::uint64_t> offsets_;  // empty while every face is a triangle
    std::vector<std::uint64_t> dropped_;
};

/// Triangles of one polygon as corner triples (positions in `corners`), n − 2 of them: quads take the better diagonal,
/// a polygon that its fan from the first corner covers (a convex one, say) takes that fan, others are cut by ears in
/// the plane of their Newell normal. Polygons that have no such cut, or very many corners, take the fan whatever it
/// looks like.
void triangulate_polygon(const std::vector<double>& vertices, std::span<const std::int32_t> corners,
                         std::vector<std::int32_t>& triples);

}  // namespace gaussmap::io
