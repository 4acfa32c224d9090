// surfaces FOLDER SEED [NAME …]: writes the clouds and meshes of the accuracy benches as
// FOLDER/clouds/NAME_SAMPLING.ply and FOLDER/meshes/NAME_KIND.ply, "_sSEED" before the dot for seeds other than 1.
//
// Every vertex carries the exact unit normal (nx ny nz) and exact density (exact_density, 1/length²) of the clean
// surface at the place it was moved from by noise; all in double precision.
//
// Clouds: uniform (Poisson-disk, 20 000), nonuniform (a random half of 40 000), sparse (2 000), and n0.1, n0.2, n0.5,
// n1: the uniform ones with Gaussian noise in each coordinate of that percentage of the bounding box's diagonal. Meshes
// of 10 to 21 thousand vertices: regular, jittered (vertices moved along the surface by up to a quarter of an edge),
// n0.5, n1, n2 (jittered, then Gaussian noise of that percentage of the mean edge), anisotropic (grid stretched so that
// cells are about 5 : 1; surfaces over a grid only).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gaussmap/io.h"
#include "gaussmap/surfaces.h"
#include "more_surfaces.h"
#include "sampling.h"

namespace {

using gaussmap::Surface;
using gaussmap::SurfaceOptions;

/// How fine: a grid around × across, or an icosahedron subdivided `across` = 0 times `around`.
struct Resolution {
    int around = 0, across = 0;
};

struct Subject {
    std::string name;
    Resolution mesh, dense;
    std::function<Surface(Resolution, const SurfaceOptions&)> make;
};

const std::vector<Subject>& subjects() {
    using R = Resolution;
    using O = SurfaceOptions;
    using namespace gaussmap;
    // Tube radii leave strands at least 1.9 diameters apart, centre to centre.
    static const std::vector<Subject> table = {
        {"torus5", {168, 84}, {1400, 560}, [](R r, const O& o) { return torus(1, 0.5, r.around, r.across, o); }},
        {"torus7", {140, 100}, {1200, 700}, [](R r, const O& o) { return torus(1, 0.7, r.around, r.across, o); }},
        {"knot23",
         {500, 30},
         {4000, 200},
         [](R r, const O& o) { return torus_knot(2, 3, 1, 0.5, 0.15, r.around, r.across, o); }},
        {"knot35",
         {960, 22},
         {6000, 130},
         [](R r, const O& o) { return torus_knot(3, 5, 1, 0.5, 0.09, r.around, r.across, o); }},
        {"fig8",
         {600, 24},
         {4500, 170},
         [](R r, const O& o) { return figure_eight_knot(1.0 / 3, 0.1, r.around, r.across, o); }},
        {"ell", {5, 0}, {8, 0}, [](R r, const O& o) { return ellipsoid(1, 0.6, 0.35, r.around, o); }},
        {"bumpy", {5, 0}, {8, 0}, [](R r, const O& o) { return bumpy_sphere(1, 0.1, 4, r.around, o); }},
        {"cube", {5, 0}, {8, 0}, [](R r, const O& o) { return rounded_cube(0.2, r.around, o); }},
        {"waves",
         {120, 120},
         {900, 900},
         [](R r, const O& o) { return waves(1, 1, 0.05, 0.5, r.around, r.across, o); }},
        {"catenoid", {200, 66}, {1400, 500}, [](R r, const O& o) { return catenoid(1, 2, r.around, r.across, o); }},
        {"monkey", {120, 120}, {900, 900}, [](R r, const O& o) { return monkey_saddle(0.5, r.around, r.across, o); }},
    };
    return table;
}

std::vector<double> vertex_areas(const Surface& surface) {
    std::vector<double> area(surface.density.size());
    for (std::size_t f = 0; f < surface.faces.size(); f += 3) {
        const std::int32_t* abc = &surface.faces[f];
        std::array<double, 3> u{}, v{};
        for (int c = 0; c < 3; ++c) {
            u[c] = surface.vertices[3 * abc[1] + c] - surface.vertices[3 * abc[0] + c];
            v[c] = surface.vertices[3 * abc[2] + c] - surface.vertices[3 * abc[0] + c];
        }
        const double twice =
            std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
        for (int c = 0; c < 3; ++c) area[abc[c]] += twice / 6;
    }
    return area;
}

/// Points all over the surface, each standing for the area of its cell.
Candidates candidates_on(const Subject& subject, std::uint64_t seed) {
    SurfaceOptions anywhere_in_the_cell;
    anywhere_in_the_cell.jitter = 0.5;
    anywhere_in_the_cell.seed = seed;
    return {subject.make(subject.dense, anywhere_in_the_cell), vertex_areas(subject.make(subject.dense, {}))};
}

gaussmap::Geometry geometry_of(const Surface& surface) {
    gaussmap::Geometry geometry;
    geometry.vertices = surface.vertices;
    geometry.faces = surface.faces;
    geometry.normals = surface.normals;
    geometry.normal_type = gaussmap::Type::float64;
    geometry.vertex_properties = {gaussmap::make_property("exact_density", surface.density, gaussmap::Type::float64)};
    return geometry;
}

/// The chosen vertices as a cloud.
Surface chosen(const Surface& surface, const std::vector<std::size_t>& indices) {
    Surface cloud;
    for (const std::size_t i : indices) {
        for (int c = 0; c < 3; ++c) {
            cloud.vertices.push_back(surface.vertices[3 * i + c]);
            cloud.normals.push_back(surface.normals[3 * i + c]);
        }
        cloud.density.push_back(surface.density[i]);
    }
    return cloud;
}

double diagonal(const Surface& surface) {
    std::array<double, 3> low, high;
    low.fill(INFINITY), high.fill(-INFINITY);
    for (std::size_t j = 0; j < surface.vertices.size(); ++j) {
        low[j % 3] = std::min(low[j % 3], surface.vertices[j]);
        high[j % 3] = std::max(high[j % 3], surface.vertices[j]);
    }
    return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

struct Writer {
    std::filesystem::path folder;
    std::string suffix;

    void operator()(const std::string& name, const std::string& cell, const Surface& surface) const {
        gaussmap::write((folder / (name + "_" + cell + suffix + ".ply")).string(), geometry_of(surface));
    }
};

void write_clouds(const Subject& subject, std::uint64_t seed, const Writer& write) {
    constexpr std::size_t fine = 20000, coarse = 2000;
    const Candidates candidates = candidates_on(subject, seed);
    Dice dice(seed);
    const Surface uniform = chosen(candidates.surface, poisson_disk(candidates, fine, dice));
    write(subject.name, "uniform", uniform);
    std::vector<std::size_t> half = poisson_disk(candidates, 2 * fine, dice);
    half.resize(fine);  // their order is random
    write(subject.name, "nonuniform", chosen(candidates.surface, half));
    write(subject.name, "sparse", chosen(candidates.surface, poisson_disk(candidates, coarse, dice)));
    const double size = diagonal(uniform);
    for (const char* percent : {"0.1", "0.2", "0.5", "1"}) {
        Surface noisy = uniform;
        for (double& coordinate : noisy.vertices) coordinate += std::stod(percent) / 100 * size * dice.normal();
        write(subject.name, std::string("n") + percent, noisy);
    }
}

void write_meshes(const Subject& subject, std::uint64_t seed, const Writer& write) {
    SurfaceOptions options;
    options.seed = seed;
    const Resolution fine = subject.mesh;
    write(subject.name, "regular", subject.make(fine, options));
    if (fine.across > 0) {
        const double stretch = std::sqrt(5.0);
        const Resolution stretched{static_cast<int>(fine.around / stretch), static_cast<int>(fine.across * stretch)};
        write(subject.name, "anisotropic", subject.make(stretched, options));
    }
    options.jitter = 0.25;
    write(subject.name, "jittered", subject.make(fine, options));
    for (const char* percent : {"0.5", "1", "2"}) {
        options.noise = std::stod(percent) / 100;
        write(subject.name, std::string("n") + percent, subject.make(fine, options));
    }
}

void run(const std::filesystem::path& folder, std::uint64_t seed, const std::vector<std::string>& names) {
    const std::string suffix = seed == 1 ? "" : "_s" + std::to_string(seed);
    for (const char* kind : {"clouds", "meshes"}) std::filesystem::create_directories(folder / kind);
    for (const Subject& subject : subjects()) {
        if (!names.empty() && std::find(names.begin(), names.end(), subject.name) == names.end()) continue;
        write_meshes(subject, seed, {folder / "meshes", suffix});
        write_clouds(subject, seed, {folder / "clouds", suffix});
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: surfaces FOLDER SEED [NAME ...]\n");
        return 2;
    }
    try {
        run(argv[1], std::stoull(argv[2]), {argv + 3, argv + argc});
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "surfaces: %s\n", problem.what());
        return 1;
    }
    return 0;
}
