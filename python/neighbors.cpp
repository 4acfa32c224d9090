// neighbors.h for Python.
#include "gaussmap/neighbors.h"

#include "arrays.h"
#include "bindings.h"
#include "execution.h"

namespace binding {
namespace {

using namespace nb::literals;

nb::any nearest_neighbors(const PointArray& cloud, int k, int threads, const nb::object& progress) {
    auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        return gaussmap::nearest_neighbors(points(cloud), k, run);
    });
    return array(std::move(found.index), static_cast<std::size_t>(k));
}

Tuple nearest_points(const PointArray& cloud, const PointArray& queries, int k, int threads,
                     const nb::object& progress) {
    auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        const gaussmap::NeighborIndex index(points(cloud), run);
        return index.nearest(points(queries), k, true, run);
    });
    return nb::make_tuple(array(std::move(found.index), static_cast<std::size_t>(k)),
                          array(std::move(found.squared_distance), static_cast<std::size_t>(k)));
}

Tuple fans(const PointArray& cloud, const PointArray& normals, const IndexTable& neighbors, int threads,
           const nb::object& progress) {
    gaussmap::Neighbors rows;
    rows.k = neighbors.shape(1);
    rows.index.assign(neighbors.data(), neighbors.data() + neighbors.size());
    auto found = released(threads, progress, [&](const gaussmap::Execution& run) {
        return gaussmap::fans(points(cloud), points(normals), rows, run);
    });
    return nb::make_tuple(array(std::move(found.begin)), array(std::move(found.index)), array(std::move(found.closed)));
}

}  // namespace

void bind_neighbors(nb::module_& m) {
    m.def("nearest_neighbors", nearest_neighbors, "points"_a.noconvert(), "k"_a, "threads"_a, "progress"_a.none());
    m.def("nearest_points", nearest_points, "points"_a.noconvert(), "queries"_a.noconvert(), "k"_a, "threads"_a,
          "progress"_a.none());
    m.def("fans", fans, "points"_a.noconvert(), "normals"_a.noconvert(), "neighbors"_a.noconvert(), "threads"_a,
          "progress"_a.none());
}

}  // namespace binding
