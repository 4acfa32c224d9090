// Vertex normals of a mesh as weighted sums of face normals (docs/method.md, eq. (5)).
#include <cmath>
#include <limits>

#include "degenerate.h"
#include "gaussmap/normals.h"
#include "normalize.h"
#include "scatter.h"
#include "vec.h"

namespace gaussmap {
namespace {

/// The weighted face normals that one triangle gives to its three corners.
struct CornerNormals {
    Vec3 a, b, c;
};

/// The angle between two edges; atan2 keeps its accuracy near 0 and π.
double angle(Vec3 e, Vec3 f) {
    return std::atan2(length(cross(e, f)), dot(e, f));
}

/// \param normal  (b − a) × (c − a), of length twice the area.
template <NormalWeights weights>
CornerNormals corner_normals(Vec3 ab, Vec3 ac, Vec3 bc, Vec3 normal) {
    if constexpr (weights == NormalWeights::area) {
        return {normal, normal, normal};
    } else if constexpr (weights == NormalWeights::angle) {
        const Vec3 unit = (1 / length(normal)) * normal;
        return {angle(ab, ac) * unit, angle(bc, -ab) * unit, angle(ac, bc) * unit};
    } else {
        // sin α / (|e1| |e2|) times the unit normal is e1 × e2 / (|e1|² |e2|²): no root, one division.
        const double ab2 = squared(ab), ac2 = squared(ac), bc2 = squared(bc);
        const Vec3 scaled = (1 / (ab2 * ac2 * bc2)) * normal;
        return {bc2 * scaled, ac2 * scaled, ab2 * scaled};
    }
}

/// Sums of the weighted face normals at every vertex; triangles without area and non-finite ones add nothing.
template <NormalWeights weights>
std::vector<double> normal_sums(Points vertices, Triangles faces, const Execution& run) {
    return scatter_faces<3>(faces, vertices.count, run, [&](std::size_t f, auto& corners) {
        const Vec3 a = load(vertices[faces[f][0]]), b = load(vertices[faces[f][1]]), c = load(vertices[faces[f][2]]);
        const Vec3 ab = b - a, ac = c - a, bc = c - b, normal = cross(ab, ac);
        const double half_squares = 0.5 * (squared(ab) + squared(ac) + squared(bc));
        if (!(half_squares < std::numeric_limits<double>::infinity()) || no_area(squared(normal), half_squares))
            return false;
        const CornerNormals n = corner_normals<weights>(ab, ac, bc, normal);
        if (!finite(n.a) || !finite(n.b) || !finite(n.c)) return false;
        store(corners[0], n.a), store(corners[1], n.b), store(corners[2], n.c);
        return true;
    });
}

}  // namespace

std::vector<double> mesh_normals(Points vertices, Triangles faces, NormalWeights weights, const Execution& run) {
    std::vector<double> normals;
    switch (weights) {
        case NormalWeights::max:
            normals = normal_sums<NormalWeights::max>(vertices, faces, run);
            break;
        case NormalWeights::angle:
            normals = normal_sums<NormalWeights::angle>(vertices, faces, run);
            break;
        case NormalWeights::area:
            normals = normal_sums<NormalWeights::area>(vertices, faces, run);
            break;
    }
    normalize(normals, run);
    return normals;
}

}  // namespace gaussmap
