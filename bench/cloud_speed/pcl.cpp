#include <pcl/features/normal_3d.h>
#include <pcl/features/principal_curvatures.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include "peers.h"

std::vector<double> pcl_cloud(gaussmap::Points points, int k) {
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
    for (std::size_t i = 0; i < points.count; ++i) {
        const double* p = points[i];
        cloud->emplace_back(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    }
    const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
    const pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud);
    estimation.setSearchMethod(tree);
    estimation.setKSearch(k + 1);  // the point itself is one
    estimation.compute(*normals);
    pcl::PrincipalCurvaturesEstimation<pcl::PointXYZ, pcl::Normal, pcl::PrincipalCurvatures> curvatures;
    curvatures.setInputCloud(cloud);
    curvatures.setInputNormals(normals);
    curvatures.setSearchMethod(tree);
    curvatures.setKSearch(k + 1);
    pcl::PointCloud<pcl::PrincipalCurvatures> found;
    curvatures.compute(found);
    std::vector<double> density(points.count);
    for (std::size_t i = 0; i < points.count; ++i)
        density[i] = double(found[i].pc1) * found[i].pc1 + double(found[i].pc2) * found[i].pc2;
    return density;
}
