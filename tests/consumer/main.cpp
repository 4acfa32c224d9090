#include <gaussmap/gaussmap.h>

#include <cstdio>

int main() {
    const gaussmap::Surface ball = gaussmap::sphere(3, 2.0);
    const auto result = gaussmap::mesh_curvature(ball.vertices, ball.faces);
    std::printf("density %.6f\n", result.density[0]);
}
