// cgal_jets FILE POINTS DEGREE:K …: CGAL's Monge_via_jet_fitting (Cazals, Pouget 2005) on a cloud.
//
// The osculating jet of that degree through each point and its K nearest others; density = k1² + k2² of its Monge form.
// POINTS: how many of the first points are judged (0: all); neighbours come from the whole cloud. The seconds are those
// of the fits alone, the search for neighbours not included.
#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "gaussmap/neighbors.h"
#include "judge.h"

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Fitting = CGAL::Monge_via_jet_fitting<Kernel>;

double density_at(const std::vector<Point>& near, int degree) {
    Fitting fitting;
    const auto form = fitting(near.begin(), near.end(), static_cast<std::size_t>(degree), 2);
    const double k1 = form.principal_curvatures(0), k2 = form.principal_curvatures(1);
    return k1 * k1 + k2 * k2;
}

struct Setting {
    int degree, k;
};

Setting setting_of(const std::string& text) {
    const std::size_t colon = text.find(':');
    return {std::stoi(text.substr(0, colon)), std::stoi(text.substr(colon + 1))};
}

void run(const std::string& path, std::size_t points, const std::vector<Setting>& settings) {
    const Shape shape = read_shape(path);
    const std::vector<double>& xyz = shape.geometry.vertices;
    const std::size_t count = points == 0 ? shape.truth.size() : std::min(points, shape.truth.size());
    int widest = 0;
    for (const Setting& s : settings) widest = std::max(widest, s.k);
    const gaussmap::Neighbors neighbors = gaussmap::nearest_neighbors(xyz, widest);
    const auto point = [&](std::size_t i) { return Point(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]); };
    std::vector<Point> near;
    for (const Setting& s : settings) {
        const double start = now();
        std::vector<double> density;
        for (std::size_t i = 0; i < count; ++i) {
            near.assign(1, point(i));
            for (int j = 0; j < s.k && neighbors[i][j] >= 0; ++j) near.push_back(point(neighbors[i][j]));
            density.push_back(density_at(near, s.degree));
        }
        report("CGAL " CGAL_VERSION_STR " jets", "degree " + std::to_string(s.degree) + " k " + std::to_string(s.k),
               density, shape.truth, now() - start);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: cgal_jets FILE POINTS DEGREE:K ...\n");
        return 2;
    }
    try {
        std::vector<Setting> settings;
        for (int i = 3; i < argc; ++i) settings.push_back(setting_of(argv[i]));
        run(argv[1], std::stoul(argv[2]), settings);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "cgal_jets: %s\n", problem.what());
        return 1;
    }
    return 0;
}
