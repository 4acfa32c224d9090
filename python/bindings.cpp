// The extension module: each function checks its arrays, releases the interpreter's lock, calls the library and wraps
// what it gives. The package in python/gaussmap is what people use.
#include "bindings.h"

#include "arrays.h"
#include "gaussmap/types.h"

NB_MODULE(_gaussmap, m) {
    m.doc() = "The compiled part of gaussmap; import gaussmap instead.";
    m.def(
        "addresses",
        [](const binding::PointArray& points, const binding::FaceArray& faces) {
            return std::make_pair(reinterpret_cast<std::uintptr_t>(points.data()),
                                  reinterpret_cast<std::uintptr_t>(faces.data()));
        },
        nanobind::arg("points").noconvert(), nanobind::arg("faces").noconvert(),
        "Where the library would read the arrays: their own memory, as the tests check.");
    nanobind::exception<gaussmap::Cancelled>(m, "Cancelled", PyExc_RuntimeError);
    binding::bind_curvature(m);
    binding::bind_neighbors(m);
    binding::bind_surfaces(m);
    binding::bind_shapes(m);
    binding::bind_files(m);
    binding::bind_page(m);
}
