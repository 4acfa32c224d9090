// Pages among the outputs: scenes made of what a file holds and of what was measured on it.
#pragma once

#include <string>
#include <vector>

#include "files.h"
#include "gaussmap/page.h"

namespace cli {

/// The geometry, by the name of its file. It must outlive the scene, and `normals` too (empty: those of the file).
gaussmap::PageScene page_scene(const std::string& path, const gaussmap::Geometry& geometry, bool mesh,
                               const std::vector<double>& normals);

/// Values that were measured, as a PLY file of them would hold them: rounded to float32.
void add_measured(gaussmap::PageScene& scene, const std::string& name, const std::vector<double>& values,
                  bool of_faces = false);

/// The properties of one number a vertex or triangle, but for colours, directions and what the scene has already.
void add_properties(gaussmap::PageScene& scene, const std::vector<gaussmap::Property>& properties, bool of_faces);

/// Make the page once, and write it to every .html of the outputs.
void write_pages(const Outputs& outputs, const std::vector<gaussmap::PageScene>& scenes, gaussmap::PageOptions options,
                 const Common& common);

}  // namespace cli
