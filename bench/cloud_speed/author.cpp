// A program built like the author's, one part after the other so that each can be timed.
#include "author.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <ctime>

#include "peers.h"

namespace {

using Matrix = Eigen::MatrixXd;
using Indices = Eigen::MatrixXi;
using Eigen::all;

/// The neighbours in the plane that fits them best, from a singular value decomposition with all of both bases. (The
/// axes are as long as the normal's angle to the x axis makes them, which no triangulation minds.)
Matrix projected(const Matrix& around) {
    const Eigen::Vector3d mean = around.transpose().rowwise().mean(), origin = around.row(0).transpose();
    const Matrix centred = around.transpose().colwise() - mean;
    const Eigen::JacobiSVD<Matrix> svd(centred, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d normal = svd.matrixU()(all, 2), x = normal.cross(Eigen::Vector3d::UnitX()),
                          y = normal.cross(x);
    const Matrix offsets = around.rowwise() - origin.transpose();
    Matrix plane(around.rows(), 2);
    plane << offsets * x, offsets * y;
    return plane;
}

/// Those of the triangles that hold the first point.
Indices triangles_at_first(const Indices& triangles) {
    std::vector<int> rows;
    for (int t = 0; t < triangles.rows(); ++t)
        for (int c = 0; c < triangles.cols(); ++c)
            if (triangles(t, c) == 0) rows.push_back(t);
    return triangles(rows, all);
}

/// The same with the numbers that their corners have in the cloud.
Indices in_cloud(const Indices& triangles, const Indices& numbers) {
    const Indices x = numbers(all, triangles(all, 0)), y = numbers(all, triangles(all, 1)),
                  z = numbers(all, triangles(all, 2));
    Indices result(3, x.cols());
    result << x, y, z;
    return result.transpose();
}

/// Half the cotangents of a triangle's corners, from the lengths of its sides: areas by Kahan's form of Heron's
/// formula, the sides in order of length.
Matrix half_cotangents(const Matrix& corners, const Indices& triangle) {
    Matrix squares(1, 3);
    for (int c = 0; c < 3; ++c)
        squares(0, c) = (corners.row(triangle(0, (c + 1) % 3)) - corners.row(triangle(0, (c + 2) % 3))).squaredNorm();
    const Matrix lengths = squares.array().sqrt();
    Matrix l = lengths;
    std::sort(l.data(), l.data() + 3, std::greater<>());
    Eigen::VectorXd double_area(1);
    double_area(0) =
        std::sqrt((l(0) + (l(1) + l(2))) * (l(2) - (l(0) - l(1))) * (l(2) + (l(0) - l(1))) * (l(0) + (l(1) - l(2)))) /
        2;
    Matrix result(1, 3);
    for (int c = 0; c < 3; ++c)
        result(0, c) = (squares(0, (c + 1) % 3) + squares(0, (c + 2) % 3) - squares(0, c)) / double_area(0) / 4;
    return result;
}

/// The sparse cotangent matrix of a mesh of one triangle, negative semidefinite as libigl has it.
Eigen::SparseMatrix<double> cotangent_matrix(const Matrix& corners, const Indices& triangle) {
    Eigen::SparseMatrix<double> result(corners.rows(), corners.rows());
    result.reserve(10 * corners.rows());
    const Matrix weights = half_cotangents(corners, triangle);
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(12);
    for (int c = 0; c < 3; ++c) {
        const int i = triangle(0, (c + 1) % 3), j = triangle(0, (c + 2) % 3);
        entries.emplace_back(i, j, weights(0, c));
        entries.emplace_back(j, i, weights(0, c));
        entries.emplace_back(i, i, -weights(0, c));
        entries.emplace_back(j, j, -weights(0, c));
    }
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

double density_of(const Indices& triangles, const Matrix& points, const Matrix& normals) {
    double kappa = 0, areas = 0;
    for (int t = 0; t < triangles.rows(); ++t) {
        const Indices row = triangles(t, all);
        const std::vector<int> corner = {row(0, 0), row(0, 1), row(0, 2)};
        const Matrix corners = points(corner, all), n = normals(corner, all);
        const Matrix side = corners(0, all) - corners(1, all), other = corners(0, all) - corners(2, all);
        const Eigen::Vector3d a(side(0, 0), side(0, 1), side(0, 2)), b(other(0, 0), other(0, 1), other(0, 2));
        Indices triangle(1, 3);
        triangle << 0, 1, 2;
        const Eigen::SparseMatrix<double> l = cotangent_matrix(corners, triangle);
        for (int axis = 0; axis < 3; ++axis) {
            const Matrix x = n(all, axis);
            kappa -= (x.transpose() * l * x)(0);
        }
        areas += std::sqrt(a.cross(b).squaredNorm()) / 2;
    }
    return kappa / areas;
}

Matrix matrix_of(gaussmap::Points points) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const Rows>(points.xyz, static_cast<Eigen::Index>(points.count), 3);
}

/// Microseconds of work since the last call.
struct Stopwatch {
    std::clock_t last = std::clock();

    double lap() {
        const std::clock_t begin = last;
        last = std::clock();
        return 1e6 * static_cast<double>(last - begin) / CLOCKS_PER_SEC;
    }
};

}  // namespace

AuthorCloud author_cloud(gaussmap::Points cloud, gaussmap::Points cloud_normals, std::size_t queries, int k) {
    const Matrix points = matrix_of(cloud), normals = matrix_of(cloud_normals);
    AuthorCloud result;
    Stopwatch watch;
    const author::Octree tree = author::octree(points);
    result.work.octree = watch.lap() / static_cast<double>(cloud.count);
    const Indices neighbors = author::nearest(points, tree, static_cast<int>(queries), k);
    result.work.search = watch.lap() / static_cast<double>(queries);
    std::vector<Matrix> planes(queries);
    for (std::size_t i = 0; i < queries; ++i) {
        const Indices numbers = neighbors(i, all);
        const std::vector<int> rows(numbers.data(), numbers.data() + numbers.size());
        planes[i] = projected(points(rows, all));
    }
    result.work.plane = watch.lap() / static_cast<double>(queries);
    std::vector<Indices> triangles(queries);
    for (std::size_t i = 0; i < queries; ++i) triangles[i] = author::delaunay(planes[i]);
    result.work.delaunay = watch.lap() / static_cast<double>(queries);
    result.density.resize(queries);
    for (std::size_t i = 0; i < queries; ++i)
        result.density[i] = density_of(in_cloud(triangles_at_first(triangles[i]), neighbors(i, all)), points, normals);
    result.work.energy = watch.lap() / static_cast<double>(queries);
    for (std::size_t i = 0; i < queries; ++i) {
        for (int j = 0; j < k; ++j) {
            result.neighbors.push_back(neighbors(i, j));
            for (int a = 0; a < 2; ++a) result.planes.push_back(planes[i](j, a));
        }
        for (int t = 0; t < triangles[i].rows(); ++t)
            for (int c = 0; c < 3; ++c) result.triangles.push_back(triangles[i](t, c));
        result.triangle_counts.push_back(static_cast<int>(triangles[i].rows()));
    }
    return result;
}
