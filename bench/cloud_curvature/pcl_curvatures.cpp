// pcl_curvatures FILE POINTS K …: PCL's NormalEstimation and PrincipalCurvaturesEstimation, both with K neighbours.
//
// pc1 and pc2 are the eigenvalues of the covariance of the neighbours' normals projected onto the tangent plane: their
// sum grows like (k1² + k2²) times the squared radius of the neighbourhood, and PCL does not divide by it. Hence both
// pc1 + pc2 and pc1² + pc2² are told, raw and (another column) rescaled to the truth. PCL computes in single precision.
#include <pcl/features/normal_3d.h>
#include <pcl/features/principal_curvatures.h>
#include <pcl/pcl_config.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "judge.h"

namespace {

void run(const std::string& path, std::size_t points, const std::vector<int>& ks) {
    const Shape shape = read_shape(path);
    const std::size_t n = shape.truth.size(), count = points == 0 ? n : std::min(points, n);
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
    for (std::size_t i = 0; i < n; ++i) {
        const double* p = &shape.geometry.vertices[3 * i];
        cloud->emplace_back(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    }
    for (const int k : ks) {
        const double start = now();
        const pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
        pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> of_normals;
        of_normals.setInputCloud(cloud);
        of_normals.setKSearch(k + 1);  // PCL counts the point itself
        of_normals.compute(*normals);
        pcl::PointCloud<pcl::PrincipalCurvatures> curvatures;
        pcl::PrincipalCurvaturesEstimation<pcl::PointXYZ, pcl::Normal, pcl::PrincipalCurvatures> of_curvatures;
        of_curvatures.setInputCloud(cloud);
        of_curvatures.setInputNormals(normals);
        of_curvatures.setKSearch(k + 1);
        of_curvatures.compute(curvatures);
        const double seconds = now() - start;
        std::vector<double> sum, squares;
        for (std::size_t i = 0; i < count; ++i) {
            const double pc1 = curvatures[i].pc1, pc2 = curvatures[i].pc2;
            sum.push_back(pc1 + pc2);
            squares.push_back(pc1 * pc1 + pc2 * pc2);
        }
        const std::string parameter = "k " + std::to_string(k);
        report("PCL " PCL_VERSION_PRETTY " pc1+pc2", parameter, sum, shape.truth, seconds);
        report("PCL " PCL_VERSION_PRETTY " pc1^2+pc2^2", parameter, squares, shape.truth, seconds);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: pcl_curvatures FILE POINTS K ...\n");
        return 2;
    }
    try {
        std::vector<int> ks;
        for (int i = 3; i < argc; ++i) ks.push_back(std::stoi(argv[i]));
        run(argv[1], std::stoul(argv[2]), ks);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "pcl_curvatures: %s\n", problem.what());
        return 1;
    }
    return 0;
}
