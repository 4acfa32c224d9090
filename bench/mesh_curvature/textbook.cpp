#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "peers.h"

namespace {

// The way it reads in a textbook, and in most programs: small dynamic matrices, a sparse one from triplets.
using Matrix = Eigen::MatrixXd;

double cotangent(const Eigen::VectorXd& e, const Eigen::VectorXd& f, double twice_area) {
    return e.dot(f) / twice_area;
}

double double_area(const Matrix& corners) {
    const Eigen::Vector3d e = corners.row(1) - corners.row(0), f = corners.row(2) - corners.row(0);
    return e.cross(f).norm();
}

/// The cotangent matrix of one triangle, a corner a row.
Eigen::SparseMatrix<double> cotangent_matrix(const Matrix& corners) {
    const double twice_area = double_area(corners);
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double half =
            0.5 * cotangent(corners.row(i) - corners.row(k), corners.row(j) - corners.row(k), twice_area);
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
        Matrix corners(3, 3), n(3, 3);
        for (int c = 0; c < 3; ++c) {
            corners.row(c) = Eigen::Map<const Eigen::RowVector3d>(vertices[faces[f][c]]);
            n.row(c) = Eigen::Map<const Eigen::RowVector3d>(normals[faces[f][c]]);
        }
        const Eigen::SparseMatrix<double> s = cotangent_matrix(corners);
        const Matrix energy = n.transpose() * s * n;
        const double a = 0.5 * double_area(corners);
        for (int c = 0; c < 3; ++c) kappa[faces[f][c]] += energy.trace(), area[faces[f][c]] += a;
    }
    for (std::size_t v = 0; v < kappa.size(); ++v) kappa[v] /= area[v];
    return kappa;
}
