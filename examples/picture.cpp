// Three surfaces side by side in one picture, coloured by their total curvature: docs/picture.png of the README.
//
//   example_picture OUT.png
#include <gaussmap/gaussmap.h>

#include <cmath>
#include <cstdio>
#include <exception>

namespace {

struct Scene {
    std::vector<double> vertices, density;
    std::vector<std::int32_t> faces;
};

/// Put a surface into the scene: turned about z, tilted about x, moved along x.
void place(Scene& scene, const gaussmap::Surface& s, double turn, double tilt, double x) {
    const auto first = static_cast<std::int32_t>(scene.vertices.size() / 3);
    for (std::size_t i = 0; i < s.vertices.size(); i += 3) {
        const double a = std::cos(turn) * s.vertices[i] - std::sin(turn) * s.vertices[i + 1];
        const double b = std::sin(turn) * s.vertices[i] + std::cos(turn) * s.vertices[i + 1], c = s.vertices[i + 2];
        scene.vertices.insert(scene.vertices.end(), {a + x, std::cos(tilt) * b - std::sin(tilt) * c,
                                                     std::sin(tilt) * b + std::cos(tilt) * c});
    }
    const auto curvature = gaussmap::mesh_curvature(s.vertices, s.faces);
    scene.density.insert(scene.density.end(), curvature.density.begin(), curvature.density.end());
    for (const std::int32_t v : s.faces) scene.faces.push_back(first + v);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: example_picture OUT.png\n");
        return 2;
    }
    try {
        Scene scene;
        place(scene, gaussmap::torus_knot(2, 3, 0.86, 0.42, 0.25, 900, 70), 0.5, -0.55, -3.1);
        place(scene, gaussmap::bumpy_sphere(1.13, 0.13, 4.6, 7), 0.6, -0.4, 0);
        place(scene, gaussmap::torus(0.95, 0.6, 300, 150), 0, -0.75, 3.05);
        gaussmap::PictureOptions options;
        options.width = 1200, options.height = 500;
        options.direction = {0, 0, 1}, options.up = {0, 1, 0};
        const auto picture = gaussmap::draw(scene.vertices, scene.faces, scene.density, {}, options);
        gaussmap::write_file(argv[1], gaussmap::png_bytes(picture));
    } catch (const std::exception& e) {
        std::fprintf(stderr, "example_picture: %s\n", e.what());
        return 1;
    }
}
