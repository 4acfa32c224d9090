// The faces as a file of polygons lists them.
#pragma once

#include <cstdint>
#include <span>

#include "gaussmap/io.h"

namespace gaussmap::io {

/// The polygons where they are known, else the triangles. The geometry must outlive it.
class FaceRows {
  public:
    explicit FaceRows(const Geometry& geometry) : faces_(geometry.faces), polygons_(geometry.polygons) {}

    std::size_t count() const { return polygons_.empty() ? faces_.size() / 3 : polygons_.count(); }
    std::span<const std::int32_t> operator[](std::size_t i) const {
        if (polygons_.empty()) return {faces_.data() + 3 * i, 3};
        return {polygons_.corners.data() + polygons_.offsets[i],
                static_cast<std::size_t>(polygons_.offsets[i + 1] - polygons_.offsets[i])};
    }

  private:
    const std::vector<std::int32_t>& faces_;
    const Polygons& polygons_;
};

}  // namespace gaussmap::io
