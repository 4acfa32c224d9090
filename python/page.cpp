// page.h for Python.
#include "gaussmap/page.h"

#include "arrays.h"
#include "bindings.h"
#include "execution.h"

namespace binding {
namespace {

using namespace nb::literals;

using Values = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
/// Name, values, whether they are of faces.
using Field = std::tuple<std::string, Values, bool>;
/// Name, vertices, faces, normals, fields.
using Scene =
    std::tuple<std::string, PointArray, std::optional<FaceArray>, std::optional<PointArray>, std::vector<Field>>;

std::string page_html(const std::vector<Scene>& scenes, const std::string& title, int threads,
                      const nb::object& progress) {
    std::vector<gaussmap::PageScene> views;
    for (const auto& [name, vertices, faces, normals, fields] : scenes) {
        gaussmap::PageScene& scene = views.emplace_back();
        scene.name = name;
        scene.vertices = points(vertices);
        scene.faces = triangles(faces);
        scene.normals = points(normals);
        for (const auto& [label, values, of_faces] : fields)
            gaussmap::add_field(scene, label, {values.data(), values.data() + values.size()}, of_faces);
    }
    gaussmap::PageOptions options;
    options.title = title;
    return released(threads, progress, [&](const gaussmap::Execution& run) {
        options.run = run;
        return gaussmap::page_html(views, options);
    });
}

}  // namespace

void bind_page(nb::module_& m) {
    m.def("page_html", page_html, "scenes"_a, "title"_a, "threads"_a, "progress"_a.none());
}

}  // namespace binding
