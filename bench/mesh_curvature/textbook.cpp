#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include "peers.h"

namespace {

// The way it reads in a textbook, and in libraries that serve meshes of any size: dynamic matrices throughout,
// cotangents from edge lengths, a sparse matrix from triplets; here called once a triangle.
using Matrix = Eigen::MatrixXd;

/// Edge lengths, entry k opposite corner k.
Matrix edge_lengths(const Matrix& v, const Eigen::MatrixXi& f) {
    Matrix lengths(f.rows(), 3);
    for (int t = 0; t < f.rows(); ++t)
        for (int k = 0; k < 3; ++k) lengths(t, k) = (v.row(f(t, (k + 1) % 3)) - v.row(f(t, (k + 2) % 3))).norm();
    return lengths;
}

/// Twice the areas by Heron's formula, stable for needles with the lengths sorted (Kahan).
Matrix double_areas(const Matrix& lengths) {
    Matrix areas(lengths.rows(), 1);
    for (int t = 0; t < lengths.rows(); ++t) {
        Eigen::VectorXd l = lengths.row(t);
        std::sort(l.data(), l.data() + 3, std::greater<>());
        areas(t) = 0.5 * std::sqrt((l(0) + (l(1) + l(2))) * (l(2) - (l(0) - l(1))) * (l(2) + (l(0) - l(1))) *
                                   (l(0) + (l(1) - l(2))));
    }
    return areas;
}

/// Half the cotangents, entry k of corner k.
Matrix cotangent_entries(const Matrix& lengths, const Matrix& areas) {
    const Matrix squares = lengths.array().square();
    Matrix entries(lengths.rows(), 3);
    for (int t = 0; t < lengths.rows(); ++t)
        for (int k = 0; k < 3; ++k)
            entries(t, k) = (squares(t, (k + 1) % 3) + squares(t, (k + 2) % 3) - squares(t, k)) / (4 * areas(t));
    return entries;
}

Eigen::SparseMatrix<double> cotangent_matrix(const Matrix& v, const Eigen::MatrixXi& f, const Matrix& entries) {
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(static_cast<std::size_t>(12 * f.rows()));
    for (int t = 0; t < f.rows(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int i = f(t, (k + 1) % 3), j = f(t, (k + 2) % 3);
            triplets.emplace_back(i, j, -entries(t, k));
            triplets.emplace_back(j, i, -entries(t, k));
            triplets.emplace_back(i, i, entries(t, k));
            triplets.emplace_back(j, j, entries(t, k));
        }
    Eigen::SparseMatrix<double> s(v.rows(), v.rows());
    s.setFromTriplets(triplets.begin(), triplets.end());
    return s;
}

}  // namespace

struct Textbook {
    Matrix v, n;
    Eigen::MatrixXi f;
};

std::shared_ptr<const Textbook> textbook_mesh(gaussmap::Points vertices, gaussmap::Triangles faces,
                                              gaussmap::Points normals) {
    auto mesh = std::make_shared<Textbook>();
    const auto rows = static_cast<Eigen::Index>(vertices.count);
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    using Indices = Eigen::Matrix<std::int32_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    mesh->v = Eigen::Map<const Rows>(vertices.xyz, rows, 3);
    mesh->n = Eigen::Map<const Rows>(normals.xyz, rows, 3);
    mesh->f = Eigen::Map<const Indices>(faces.abc, static_cast<Eigen::Index>(faces.count), 3);
    return mesh;
}

std::vector<double> textbook_density(const Textbook& mesh) {
    std::vector<double> kappa(static_cast<std::size_t>(mesh.v.rows())), area(kappa.size());
    Eigen::MatrixXi corner_indices(1, 3);
    corner_indices << 0, 1, 2;
    for (Eigen::Index t = 0; t < mesh.f.rows(); ++t) {
        const Eigen::MatrixXi face = mesh.f.row(t);
        Matrix corners(3, 3), n(3, 3);
        for (int c = 0; c < 3; ++c) corners.row(c) = mesh.v.row(face(c)), n.row(c) = mesh.n.row(face(c));
        const Matrix lengths = edge_lengths(corners, corner_indices), areas = double_areas(lengths);
        const Eigen::SparseMatrix<double> s =
            cotangent_matrix(corners, corner_indices, cotangent_entries(lengths, areas));
        double energy = 0;
        for (int c = 0; c < 3; ++c) {
            const Matrix coordinate = n.col(c);
            energy += (coordinate.transpose() * s * coordinate)(0);
        }
        for (int c = 0; c < 3; ++c) {
            kappa[static_cast<std::size_t>(face(c))] += energy;
            area[static_cast<std::size_t>(face(c))] += 0.5 * areas(0);
        }
    }
    for (std::size_t v = 0; v < kappa.size(); ++v) kappa[v] /= area[v];
    return kappa;
}
