// Pictures among the outputs: drawn once, written to each .png named.
#pragma once

#include <vector>

#include "files.h"
#include "gaussmap/picture.h"

namespace cli {

/// Draw one value a vertex, as a mesh or as a cloud, and write it to every picture of the outputs.
/// `normals` as the curvature was measured with, or empty. What was drawn is returned, for the report.
gaussmap::Picture draw_pictures(const Outputs& outputs, const gaussmap::Geometry& geometry, bool mesh,
                                const std::vector<double>& values, const std::vector<double>& normals,
                                gaussmap::PictureOptions options, const Common& common);

}  // namespace cli
