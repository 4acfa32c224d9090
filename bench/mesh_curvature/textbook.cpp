#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "peers.h"

namespace {

using Vector = Eigen::Vector3d;

double cotangent(const Vector& apex, const Vector& p, const Vector& q) {
    return (p - apex).dot(q - apex) / (p - apex).cross(q - apex).norm();
}

/// The cotangent matrix of one triangle, rows and columns in the order of its corners.
Eigen::SparseMatrix<double> cotangent_matrix(const Eigen::Matrix3d& corners) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double half = 0.5 * cotangent(corners.col(k), corners.col(i), corners.col(j));
        entries.emplace_back(i, j, -half);
        entries.emplace_back(j, i, -half);
        entries.emplace_back(i, i, half);
        entries.emplace_back(j, j, half);
    }
    Eigen::SparseMatrix<double> s(3, 3);
    s.setFromTriplets(entries.begin(), entries.end());
    return s;
}

}  // namespace

std::vector<double> textbook_density(gaussmap::Points vertices, gaussmap::Triangles faces, gaussmap::Points normals) {
    std::vector<double> kappa(vertices.count), area(vertices.count);
    for (std::size_t f = 0; f < faces.count; ++f) {
        Eigen::Matrix3d corners, n;
        for (int c = 0; c < 3; ++c) {
            corners.col(c) = Eigen::Map<const Vector>(vertices[faces[f][c]]);
            n.col(c) = Eigen::Map<const Vector>(normals[faces[f][c]]);
        }
        const Eigen::Matrix3d energy = n * cotangent_matrix(corners) * n.transpose();
        const double a = 0.5 * (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).norm();
        for (int c = 0; c < 3; ++c) kappa[faces[f][c]] += energy.trace(), area[faces[f][c]] += a;
    }
    for (std::size_t v = 0; v < kappa.size(); ++v) kappa[v] /= area[v];
    return kappa;
}
