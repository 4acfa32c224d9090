// mesh_curvature on a file, once for every line on standard input: its seconds, by the clock of the caller's machine.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "gaussmap/curvature.h"
#include "gaussmap/io.h"

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const gaussmap::Geometry mesh = gaussmap::read(argv[1]);
    gaussmap::MeshCurvatureOptions options;
    options.run.threads = std::atoi(argv[2]);
    for (std::string line; std::getline(std::cin, line);) {
        const auto begin = std::chrono::steady_clock::now();
        const auto result = gaussmap::mesh_curvature(mesh.vertices, mesh.faces, {}, options);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        std::printf("%.9f %.17g\n", seconds.count(), result.kappa_sum);
        std::fflush(stdout);
    }
}
