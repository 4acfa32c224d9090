// The library's own numbers for the tests of the package: density and kappa of a file, as raw doubles on standard
// output.
#include <gaussmap/gaussmap.h>

#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const gaussmap::Geometry file = gaussmap::read(argv[1]);
    std::vector<double> density, kappa;
    if (file.faces.empty()) {
        density = gaussmap::cloud_curvature(file.vertices, file.normals).density;
    } else {
        auto found = gaussmap::mesh_curvature(file.vertices, file.faces, file.normals);
        density = std::move(found.density);
        kappa = std::move(found.kappa);
    }
    std::fwrite(density.data(), sizeof(double), density.size(), stdout);
    std::fwrite(kappa.data(), sizeof(double), kappa.size(), stdout);
}
