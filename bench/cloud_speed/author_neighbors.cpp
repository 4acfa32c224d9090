// The author's search for neighbours, after igl::octree and igl::knn.
#include <algorithm>
#include <queue>

#include "author.h"

namespace author {

namespace {

using Place = Eigen::RowVector3d;

/// A tree while it grows: one entry a cell.
struct Growing {
    std::vector<std::vector<int>> points;
    std::vector<Eigen::Matrix<int, 1, 8>> children;
    std::vector<Place> centers;
    std::vector<double> widths;

    void add(const Place& center, double width) {
        points.emplace_back();
        children.emplace_back(Eigen::Matrix<int, 1, 8>::Constant(-1));
        centers.push_back(center);
        widths.push_back(width);
    }
};

/// Bit a of a child's number tells on which side of the centre it lies along axis a.
void part(const Eigen::MatrixXd& points, Growing& tree, int cell) {
    if (tree.points.at(cell).size() <= 1) return;
    const int first = static_cast<int>(tree.widths.size());
    const Place center = tree.centers.at(cell);
    const double width = tree.widths.at(cell) / 2;
    for (int child = 0; child < 8; ++child) {
        tree.children.at(cell)(child) = first + child;
        Place shift;
        for (int a = 0; a < 3; ++a) shift(a) = (child >> a & 1) != 0 ? width / 2 : -width / 2;
        tree.add(center + shift, width);
    }
    for (std::size_t i = 0; i < tree.points.at(cell).size(); ++i) {
        const int point = tree.points.at(cell).at(i);
        int child = 0;
        for (int a = 0; a < 3; ++a) child += points(point, a) >= center(a) ? 1 << a : 0;
        tree.points.at(first + child).push_back(point);
    }
    for (int child = 0; child < 8; ++child) part(points, tree, first + child);
}

}  // namespace

Octree octree(const Eigen::MatrixXd& points) {
    Growing growing;
    const Place low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
    growing.add((low + high) / 2, (high - low).maxCoeff());
    for (int i = 0; i < points.rows(); ++i) growing.points[0].push_back(i);
    part(points, growing, 0);
    const auto cells = static_cast<Eigen::Index>(growing.widths.size());
    Octree tree{std::move(growing.points), Eigen::MatrixXi(cells, 8), Eigen::MatrixXd(cells, 3),
                Eigen::VectorXd(cells)};
    for (Eigen::Index c = 0; c < cells; ++c) {
        tree.children.row(c) = growing.children[c];
        tree.centers.row(c) = growing.centers[c];
        tree.widths(c) = growing.widths[c];
    }
    return tree;
}

Eigen::MatrixXi nearest(const Eigen::MatrixXd& points, const Octree& tree, int queries, int k) {
    const int count = static_cast<int>(points.rows()), wanted = std::min(count, k);
    Eigen::MatrixXi result(queries, wanted);
    for (int query = 0; query < queries; ++query) {
        const Place place = points.row(query);
        // Numbers below `count` are points, those from there on cells.
        const auto distance = [&](int item) {
            if (item < count) return (points.row(item) - place).norm();
            // A cell is taken for twice as wide as it is, as libigl takes it.
            const double width = tree.widths(item - count);
            const Place scaled = (place - tree.centers.row(item - count)) / width;
            return width * (scaled.array().abs() - 1).max(0.0).matrix().norm();
        };
        const auto farther = [&](int a, int b) { return distance(a) > distance(b); };
        std::priority_queue<int, std::vector<int>, decltype(farther)> waiting(farther);
        waiting.push(count);
        for (int found = 0; found < wanted;) {
            const int item = waiting.top(), cell = item - count;
            waiting.pop();
            if (item < count)
                result(query, found++) = item;
            else if (tree.children(cell, 0) != -1)
                for (int child = 0; child < 8; ++child) waiting.push(tree.children(cell, child) + count);
            else if (!tree.points.at(cell).empty())
                waiting.push(tree.points.at(cell).at(0));
        }
    }
    return result;
}

}  // namespace author
