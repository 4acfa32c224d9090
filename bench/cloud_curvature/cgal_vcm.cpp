// cgal_vcm FILE OFFSET:CONVOLUTION …: CGAL's Voronoi covariance measure (Mérigot, Ovsjanikov, Guibas 2011) on a cloud.
//
// Both radii are told in median distances to the nearest neighbour. Over a disc of radius r of a smooth surface the
// measure is the covariance of the normals n − S x, up to a factor: its largest eigenvalue belongs to the normal, and
// the others are tr S² r²/4 of it. Hence density = 4 (l1 + l2) / (l3 r²), with no factor left to choose; another column
// tells it rescaled to the truth. The seconds are those of the whole measure.
#include <CGAL/Default_diagonalize_traits.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/vcm_estimate_normals.h>
#include <CGAL/version.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "gaussmap/neighbors.h"
#include "judge.h"

namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

double median_spacing(const std::vector<double>& xyz) {
    const gaussmap::Neighbors nearest = gaussmap::nearest_neighbors(xyz, 1);
    std::vector<double> distance;
    for (std::size_t i = 0; i < xyz.size() / 3; ++i) {
        const double *p = &xyz[3 * i], *q = &xyz[3 * static_cast<std::size_t>(nearest[i][0])];
        distance.push_back(std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
    std::nth_element(distance.begin(), distance.begin() + static_cast<std::ptrdiff_t>(distance.size() / 2),
                     distance.end());
    return distance[distance.size() / 2];
}

double density_of(const std::array<double, 6>& measure, double radius) {
    std::array<double, 3> eigenvalues{};
    CGAL::Default_diagonalize_traits<double, 3>::diagonalize_selfadjoint_covariance_matrix(measure, eigenvalues);
    return 4 * (eigenvalues[0] + eigenvalues[1]) / (eigenvalues[2] * radius * radius);
}

void run(const std::string& path, const std::vector<std::string>& settings) {
    const Shape shape = read_shape(path);
    const std::vector<double>& xyz = shape.geometry.vertices;
    std::vector<Point> points;
    for (std::size_t i = 0; i < xyz.size(); i += 3) points.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
    const double spacing = median_spacing(xyz);
    for (const std::string& setting : settings) {
        const double start = now();
        const double offset = std::stod(setting), convolution = std::stod(setting.substr(setting.find(':') + 1));
        std::vector<std::array<double, 6>> measures;
        CGAL::compute_vcm(points, measures, offset * spacing, convolution * spacing);
        std::vector<double> density;
        for (const auto& measure : measures) density.push_back(density_of(measure, convolution * spacing));
        report("CGAL " CGAL_VERSION_STR " VCM", "radii " + setting + " spacings", density, shape.truth, now() - start);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: cgal_vcm FILE OFFSET:CONVOLUTION ...\n");
        return 2;
    }
    try {
        run(argv[1], {argv + 2, argv + argc});
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "cgal_vcm: %s\n", problem.what());
        return 1;
    }
    return 0;
}
