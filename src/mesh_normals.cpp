// Vertex normals of a mesh as weighted sums of face normals (docs/method.md, eq. (5)).
#include <cmath>
#include <limits>

#include "degenerate.h"
#include "gaussmap/normals.h"
#include "instruction_sets.h"
#include "max_normals.h"
#include "normalize.h"
#include "scatter.h"
#include "vec.h"
#include "weighted_normals.h"

namespace gaussmap {
namespace {

/// Triangles without area and those that are not finite.
bool adds_nothing(Vec3 ab, Vec3 ac, Vec3 bc, Vec3 normal) {
    const double half_squares = 0.5 * (squared(ab) + squared(ac) + squared(bc));
    return !(half_squares < std::numeric_limits<double>::infinity()) || no_area(squared(normal), half_squares);
}

/// The angle between two edges; atan2 keeps its accuracy near 0 and π.
double angle(Vec3 e, Vec3 f) {
    return std::atan2(length(cross(e, f)), dot(e, f));
}

std::vector<double> angle_sums(Points vertices, Triangles faces, const FaceChunks& chunks, const Execution& run) {
    return scatter_faces<3>(faces, vertices.count, chunks, run, [&](std::size_t f, double(&corners)[3][3]) {
        const Vec3 a = load(vertices[faces[f][0]]), b = load(vertices[faces[f][1]]), c = load(vertices[faces[f][2]]);
        const Vec3 ab = b - a, ac = c - a, bc = c - b, normal = cross(ab, ac);
        if (adds_nothing(ab, ac, bc, normal)) return false;
        const Vec3 unit = (1 / length(normal)) * normal;
        store(corners[0], angle(ab, ac) * unit), store(corners[1], angle(bc, -ab) * unit);
        store(corners[2], angle(ac, bc) * unit);
        return finite(unit);
    });
}

std::vector<double> area_sums(Points vertices, Triangles faces, const FaceChunks& chunks, const Execution& run) {
    return scatter_faces<3>(faces, vertices.count, chunks, run, [&](std::size_t f, double(&corners)[3][3]) {
        const Vec3 a = load(vertices[faces[f][0]]), b = load(vertices[faces[f][1]]), c = load(vertices[faces[f][2]]);
        const Vec3 ab = b - a, ac = c - a, bc = c - b, normal = cross(ab, ac);
        for (auto& corner : corners) store(corner, normal);
        return !adds_nothing(ab, ac, bc, normal) && finite(normal);
    });
}

std::vector<double> max_sums(Points vertices, Triangles faces, const FaceChunks& chunks, const Execution& run) {
    const MaxNormals normals = GAUSSMAP_FASTEST(max_normals);
    return scatter_batches<3>(faces, vertices.count, chunks, run,
                              [&](std::size_t begin, std::size_t end, auto* corners) {
                                  normals(vertices.xyz, faces[begin], end - begin, corners[0][0]);
                              });
}

}  // namespace

std::vector<double> weighted_normals(Points vertices, Triangles faces, const FaceChunks& chunks, NormalWeights weights,
                                     const Execution& run) {
    std::vector<double> normals;
    switch (weights) {
        case NormalWeights::max:
            normals = max_sums(vertices, faces, chunks, run);
            break;
        case NormalWeights::angle:
            normals = angle_sums(vertices, faces, chunks, run);
            break;
        case NormalWeights::area:
            normals = area_sums(vertices, faces, chunks, run);
            break;
    }
    normalize(normals, run);
    return normals;
}

std::vector<double> mesh_normals(Points vertices, Triangles faces, NormalWeights weights, const Execution& run) {
    return weighted_normals(vertices, faces, chunk_faces(faces, vertices.count, run), weights, run);
}

}  // namespace gaussmap
