// One function a part of the library: adds its functions to the module.
#pragma once

#include <nanobind/nanobind.h>

namespace binding {

void bind_curvature(nanobind::module_& m);
void bind_neighbors(nanobind::module_& m);
void bind_surfaces(nanobind::module_& m);
void bind_shapes(nanobind::module_& m);
void bind_files(nanobind::module_& m);
void bind_page(nanobind::module_& m);

}  // namespace binding
