// The author's triangulation, after igl::copyleft::cgal::delaunay_triangulation and what that calls.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <iterator>
#include <list>
#include <numeric>

#include "author.h"

namespace author {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 at(const Eigen::MatrixXd& plane, int i) {
    return {plane(i, 0), plane(i, 1)};
}

int turn(const Eigen::MatrixXd& plane, int a, int b, int c) {
    return CGAL::orientation(at(plane, a), at(plane, b), at(plane, c));
}

/// Indices of the rows in the order of their first values, then of their second.
template <class Matrix>
Eigen::VectorXi order_of_rows(const Matrix& rows) {
    Eigen::VectorXi order(rows.rows());
    std::iota(order.data(), order.data() + order.size(), 0);
    std::sort(order.data(), order.data() + order.size(), [&](int i, int j) {
        for (int c = 0; c < rows.cols(); ++c)
            if (rows(i, c) != rows(j, c)) return rows(i, c) < rows(j, c);
        return false;
    });
    return order;
}

/// Joins a point right of all before it with the sides of their hull that it sees, and takes those out of the hull,
/// whose corners go counterclockwise.
void join(const Eigen::MatrixXd& plane, int point, std::list<int>& hull, std::vector<Eigen::Vector3i>& triangles) {
    std::vector<int> turns;
    for (auto i = hull.begin(); i != hull.end(); ++i) {
        const int next = std::next(i) == hull.end() ? hull.front() : *std::next(i);
        turns.push_back(turn(plane, *i, next, point));
        if (turns.back() < 0) triangles.emplace_back(next, *i, point);
    }
    // Corners between two sides that are seen are inside from now on; the point comes after the one that begins them.
    std::size_t side = 0, before = turns.size() - 1;
    auto begin = hull.end();
    for (auto i = hull.begin(); i != hull.end(); before = side++) {
        const bool seen = turns[side] < 0, seen_before = turns[before] < 0;
        if (seen && !seen_before) begin = i;
        i = seen && seen_before ? hull.erase(i) : std::next(i);
    }
    hull.insert(std::next(begin), point);
}

/// Some triangulation of the points.
Eigen::MatrixXi from_left_to_right(const Eigen::MatrixXd& plane) {
    const Eigen::VectorXi order = order_of_rows(plane);
    std::vector<Eigen::Vector3i> triangles;
    std::list<int> hull;
    for (int i = 2; i < plane.rows(); ++i) {
        if (!triangles.empty()) {
            join(plane, order(i), hull, triangles);
            continue;
        }
        // All before lie on one line.
        const int side = turn(plane, order(0), order(1), order(i));
        if (side == 0) continue;
        for (int j = 0; j + 1 < i; ++j)
            triangles.emplace_back(order(side > 0 ? j : j + 1), order(side > 0 ? j + 1 : j), order(i));
        hull.assign(order.data(), order.data() + i + 1);
        if (side < 0) hull.reverse();
    }
    Eigen::MatrixXi result(triangles.size(), 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) result.row(static_cast<Eigen::Index>(t)) = triangles[t];
    return result;
}

/// Half edge c·m + t of m triangles is opposite to corner c of triangle t.
struct Edges {
    Eigen::MatrixXi ends;                  ///< of half edges, in the direction of their triangle
    Eigen::MatrixXi unique;                ///< ends of the edges
    Eigen::VectorXi edge;                  ///< of each half edge
    std::vector<std::vector<int>> halves;  ///< of each edge
};

Edges edges_of(const Eigen::MatrixXi& triangles) {
    const int m = static_cast<int>(triangles.rows());
    Edges edges{Eigen::MatrixXi(3 * m, 2), {}, Eigen::VectorXi(3 * m), {}};
    for (int c = 0; c < 3; ++c) {
        edges.ends.block(c * m, 0, m, 1) = triangles.col((c + 1) % 3);
        edges.ends.block(c * m, 1, m, 1) = triangles.col((c + 2) % 3);
    }
    Eigen::MatrixXi undirected(3 * m, 2);
    undirected << edges.ends.rowwise().minCoeff(), edges.ends.rowwise().maxCoeff();
    const Eigen::VectorXi order = order_of_rows(undirected);
    std::vector<int> firsts;
    for (int i = 0; i < 3 * m; ++i) {
        if (i == 0 || undirected.row(order(i)) != undirected.row(order(i - 1))) firsts.push_back(order(i));
        edges.edge(order(i)) = static_cast<int>(firsts.size()) - 1;
    }
    edges.unique.resize(static_cast<Eigen::Index>(firsts.size()), 2);
    for (std::size_t e = 0; e < firsts.size(); ++e)
        edges.unique.row(static_cast<Eigen::Index>(e)) = edges.ends.row(firsts[e]);
    edges.halves.resize(firsts.size());
    for (auto& halves : edges.halves) halves.reserve(2);
    for (int half = 0; half < 3 * m; ++half) edges.halves[edges.edge(half)].push_back(half);
    return edges;
}

/// A side of two triangles: left and right of the way from `from` to `to`.
struct Side {
    int t, c, u, d;  ///< the triangle on the left and its corner off the side; that on the right and its corner
    int from, to, left, right;
};

Side side_of(const Eigen::MatrixXi& triangles, const std::vector<int>& halves) {
    const int m = static_cast<int>(triangles.rows());
    const int t = halves[0] % m, c = halves[0] / m, u = halves[1] % m, d = halves[1] / m;
    return {t, c, u, d, triangles(t, (c + 1) % 3), triangles(t, (c + 2) % 3), triangles(t, c), triangles(u, d)};
}

bool is_delaunay(const Eigen::MatrixXd& plane, const Side& s) {
    return CGAL::side_of_oriented_circle(at(plane, s.from), at(plane, s.to), at(plane, s.left), at(plane, s.right)) !=
           CGAL::ON_POSITIVE_SIDE;
}

/// Puts the side between `left` and `right` in place of the one between `from` and `to`.
void flip(Eigen::MatrixXi& triangles, Edges& edges, int edge, const Side& s) {
    const int m = static_cast<int>(triangles.rows());
    struct Move {
        int old, now, edge, from, to;
    };
    const auto of = [&](int half) { return edges.edge(half); };
    const int to_left = s.t + (s.c + 1) % 3 * m, left_from = s.t + (s.c + 2) % 3 * m;
    const int from_right = s.u + (s.d + 1) % 3 * m, right_to = s.u + (s.d + 2) % 3 * m;
    const Move moves[] = {
        {edges.halves[edge][0], s.t, edge, s.right, s.left}, {edges.halves[edge][1], s.u, edge, s.left, s.right},
        {left_from, s.t + m, of(left_from), s.left, s.from}, {from_right, s.t + 2 * m, of(from_right), s.from, s.right},
        {right_to, s.u + m, of(right_to), s.right, s.to},    {to_left, s.u + 2 * m, of(to_left), s.to, s.left}};
    triangles.row(s.t) << s.from, s.right, s.left;
    triangles.row(s.u) << s.to, s.left, s.right;
    edges.unique.row(edge) << s.right, s.left;
    std::vector<int*> places;
    for (const Move& move : moves) {
        auto& halves = edges.halves[move.edge];
        places.push_back(&*std::find(halves.begin(), halves.end(), move.old));
    }
    for (std::size_t i = 0; i < std::size(moves); ++i) {
        *places[i] = moves[i].now;
        edges.edge(moves[i].now) = moves[i].edge;
        edges.ends.row(moves[i].now) << moves[i].from, moves[i].to;
    }
}

}  // namespace

Eigen::MatrixXi delaunay(const Eigen::MatrixXd& plane) {
    Eigen::MatrixXi triangles = from_left_to_right(plane);
    if (triangles.rows() == 0) return triangles;
    Edges edges = edges_of(triangles);
    for (bool flipped = true; flipped;) {
        flipped = false;
        for (int e = 0; e < static_cast<int>(edges.halves.size()); ++e) {
            if (edges.halves[e].size() != 2) continue;
            const Side side = side_of(triangles, edges.halves[e]);
            if (is_delaunay(plane, side)) continue;
            flip(triangles, edges, e, side);
            flipped = true;
        }
    }
    return triangles;
}

}  // namespace author
