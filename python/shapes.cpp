// surfaces.h for Python.
#include "arrays.h"
#include "bindings.h"
#include "gaussmap/surfaces.h"

namespace binding {
namespace {

using namespace nb::literals;

gaussmap::SurfaceOptions options_of(double jitter, double noise, std::uint64_t seed, const std::string& noise_unit) {
    using gaussmap::NoiseUnit;
    return {jitter, noise, seed,
            named<NoiseUnit>("noise_unit", noise_unit, {{"edge", NoiseUnit::edge}, {"diagonal", NoiseUnit::diagonal}})};
}

Record record_of(gaussmap::Surface&& surface) {
    Record out;
    out["vertices"] = array(std::move(surface.vertices), 3);
    out["faces"] = array(std::move(surface.faces), 3);
    out["normals"] = array(std::move(surface.normals), 3);
    out["k1"] = array(std::move(surface.k1));
    out["k2"] = array(std::move(surface.k2));
    out["density"] = array(std::move(surface.density));
    return out;
}

/// The values that a surface takes before its options; of(make) calls it without the interpreter's lock.
template <class... Values>
struct Takes {
    static auto of(gaussmap::Surface (*make)(Values..., const gaussmap::SurfaceOptions&)) {
        return
            [make](Values... values, double jitter, double noise, std::uint64_t seed, const std::string& noise_unit) {
                const gaussmap::SurfaceOptions options = options_of(jitter, noise, seed, noise_unit);
                gaussmap::Surface surface;
                {
                    const nb::gil_scoped_release release;
                    surface = make(values..., options);
                }
                return record_of(std::move(surface));
            };
    }
};

}  // namespace

void bind_shapes(nb::module_& m) {
    const auto jitter = "jitter"_a, noise = "noise"_a, seed = "seed"_a, noise_unit = "noise_unit"_a;
    m.def("sphere", Takes<int, double>::of(gaussmap::sphere), "subdivisions"_a, "radius"_a, jitter, noise, seed,
          noise_unit);
    m.def("torus", Takes<double, double, int, int>::of(gaussmap::torus), "major"_a, "minor"_a, "around"_a, "across"_a,
          jitter, noise, seed, noise_unit);
    m.def("torus_knot", Takes<int, int, double, double, double, int, int>::of(gaussmap::torus_knot), "p"_a, "q"_a,
          "major"_a, "minor"_a, "tube"_a, "around"_a, "across"_a, jitter, noise, seed, noise_unit);
    m.def("figure_eight_knot", Takes<double, double, int, int>::of(gaussmap::figure_eight_knot), "scale"_a, "tube"_a,
          "around"_a, "across"_a, jitter, noise, seed, noise_unit);
    m.def("ellipsoid", Takes<double, double, double, int>::of(gaussmap::ellipsoid), "a"_a, "b"_a, "c"_a,
          "subdivisions"_a, jitter, noise, seed, noise_unit);
    m.def("bumpy_sphere", Takes<double, double, double, int>::of(gaussmap::bumpy_sphere), "radius"_a, "amplitude"_a,
          "frequency"_a, "subdivisions"_a, jitter, noise, seed, noise_unit);
    m.def("catenoid", Takes<double, double, int, int>::of(gaussmap::catenoid), "neck"_a, "height"_a, "around"_a,
          "across"_a, jitter, noise, seed, noise_unit);
    m.def("cylinder", Takes<double, double, int, int>::of(gaussmap::cylinder), "radius"_a, "height"_a, "around"_a,
          "across"_a, jitter, noise, seed, noise_unit);
    m.def("plane", Takes<double, double, int, int>::of(gaussmap::plane), "width"_a, "depth"_a, "around"_a, "across"_a,
          jitter, noise, seed, noise_unit);
    m.def("waves", Takes<double, double, double, double, int, int>::of(gaussmap::waves), "width"_a, "depth"_a,
          "amplitude"_a, "wavelength"_a, "around"_a, "across"_a, jitter, noise, seed, noise_unit);
}

}  // namespace binding
