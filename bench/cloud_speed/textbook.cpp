#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <queue>
#include <utility>

#include "peers.h"

namespace {

using Matrix = Eigen::MatrixXd;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;

/// A kd-tree of nodes of one point each.
struct Node {
    int point, axis;
    std::unique_ptr<Node> below, above;
};

std::unique_ptr<Node> build(const Matrix& points, int* first, int* last) {
    if (first == last) return nullptr;
    Matrix low = points.row(*first), high = low;
    for (int* i = first; i != last; ++i) low = low.cwiseMin(points.row(*i)), high = high.cwiseMax(points.row(*i));
    int axis = 0;
    (high - low).row(0).maxCoeff(&axis);
    int* middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [&](int a, int b) { return points(a, axis) < points(b, axis); });
    return std::make_unique<Node>(Node{*middle, axis, build(points, first, middle), build(points, middle + 1, last)});
}

using Found = std::priority_queue<std::pair<double, int>>;

void search(const Matrix& points, const Node* node, int query, std::size_t k, Found& found) {
    if (node == nullptr) return;
    const double squared = (points.row(node->point) - points.row(query)).squaredNorm();
    if (node->point != query) {
        found.emplace(squared, node->point);
        if (found.size() > k) found.pop();
    }
    const double gap = points(query, node->axis) - points(node->point, node->axis);
    search(points, gap < 0 ? node->below.get() : node->above.get(), query, k, found);
    if (found.size() < k || gap * gap < found.top().first)
        search(points, gap < 0 ? node->above.get() : node->below.get(), query, k, found);
}

std::vector<int> neighbors_of(const Matrix& points, const Node* tree, int query, std::size_t k) {
    Found found;
    search(points, tree, query, k, found);
    std::vector<int> result;
    for (; !found.empty(); found.pop()) result.push_back(found.top().second);
    return result;
}

/// Principal directions of a point and its neighbours, the normal first.
Matrix principal_frame(const Matrix& points, int centre, const std::vector<int>& neighbors) {
    Matrix around(static_cast<Eigen::Index>(neighbors.size()) + 1, 3);
    around.row(0) = points.row(centre);
    for (std::size_t j = 0; j < neighbors.size(); ++j)
        around.row(static_cast<Eigen::Index>(j) + 1) = points.row(neighbors[j]);
    const Matrix centred = around.rowwise() - around.colwise().mean();
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(centred.transpose() * centred);
    return solver.eigenvectors();
}

/// The sparse cotangent matrix of one triangle, and its area.
Eigen::SparseMatrix<double> cotangent_matrix(const Matrix& corners, double& area) {
    std::vector<Eigen::Triplet<double>> triplets;
    const Eigen::Vector3d a = corners.row(0), b = corners.row(1), c = corners.row(2);
    area = (b - a).cross(c - a).norm() / 2;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double cotangent = (corners.row(j) - corners.row(i)).dot(corners.row(k) - corners.row(i)) / (2 * area);
        triplets.emplace_back(j, k, -cotangent / 2);
        triplets.emplace_back(k, j, -cotangent / 2);
        triplets.emplace_back(j, j, cotangent / 2);
        triplets.emplace_back(k, k, cotangent / 2);
    }
    Eigen::SparseMatrix<double> s(3, 3);
    s.setFromTriplets(triplets.begin(), triplets.end());
    return s;
}

/// The pairs of neighbours that make Delaunay triangles with the centre in its tangent plane.
std::vector<std::array<int, 2>> triangles_at(const Matrix& points, int centre, const std::vector<int>& neighbors,
                                             const Matrix& frame) {
    std::vector<std::pair<Kernel::Point_2, int>> plane = {{Kernel::Point_2(0, 0), centre}};
    for (const int j : neighbors) {
        const Matrix q = (points.row(j) - points.row(centre)) * frame.rightCols(2);
        plane.emplace_back(Kernel::Point_2(q(0), q(1)), j);
    }
    const Triangulation triangulation(plane.begin(), plane.end());
    std::vector<std::array<int, 2>> result;
    for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end(); ++face)
        for (int c = 0; c < 3; ++c)
            if (face->vertex(c)->info() == centre)
                result.push_back({face->vertex((c + 1) % 3)->info(), face->vertex((c + 2) % 3)->info()});
    return result;
}

}  // namespace

std::vector<double> textbook_cloud(gaussmap::Points cloud, int k) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Matrix points = Eigen::Map<const Rows>(cloud.xyz, static_cast<Eigen::Index>(cloud.count), 3);
    const int count = static_cast<int>(cloud.count);
    std::vector<int> order(cloud.count);
    std::iota(order.begin(), order.end(), 0);
    const auto tree = build(points, order.data(), order.data() + order.size());
    std::vector<std::vector<int>> neighbors(cloud.count);
    std::vector<Matrix> frames(cloud.count);
    for (int i = 0; i < count; ++i) {
        neighbors[i] = neighbors_of(points, tree.get(), i, static_cast<std::size_t>(k));
        frames[i] = principal_frame(points, i, neighbors[i]);
    }
    std::vector<double> density(cloud.count);
    for (int i = 0; i < count; ++i) {
        double kappa = 0, areas = 0;
        for (const auto& [a, b] : triangles_at(points, i, neighbors[i], frames[i])) {
            Matrix corners(3, 3), normals(3, 3);
            const int corner[3] = {i, a, b};
            for (int c = 0; c < 3; ++c) {
                corners.row(c) = points.row(corner[c]);
                normals.row(c) = frames[corner[c]].col(0).transpose();
                if (normals.row(c).dot(normals.row(0)) < 0) normals.row(c) *= -1;
            }
            double area = 0;
            const Eigen::SparseMatrix<double> s = cotangent_matrix(corners, area);
            kappa += (normals.transpose() * s * normals).trace();
            areas += area;
        }
        density[i] = kappa / areas;
    }
    return density;
}
