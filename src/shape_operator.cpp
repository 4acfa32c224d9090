#include "shape_operator.h"

#include <cmath>

#include "degenerate.h"
#include "parallel.h"
#include "scatter.h"

namespace gaussmap {
namespace {

constexpr std::size_t grain = 1 << 14;

/// The derivative of normals that change linearly over a triangle (0, a, b): dn(x) = (x · ga) da + (x · gb) db.
struct Derivative {
    Vec3 da, db;  ///< changes of the normal along the edges a and b
    Vec3 ga, gb;  ///< dual to the edges: a · ga = b · gb = 1, a · gb = b · ga = 0
    Vec3 plane;   ///< unit normal of the triangle
    double area;

    /// Its symmetric part in the frame (u, v) of the triangle's plane, eq. (9).
    Symmetric2 in(Vec3 u, Vec3 v) const {
        const Vec3 along_u = dot(u, ga) * da + dot(u, gb) * db, along_v = dot(v, ga) * da + dot(v, gb) * db;
        return {dot(u, along_u), 0.5 * (dot(u, along_v) + dot(v, along_u)), dot(v, along_v)};
    }

    /// The same in the frame (u, v) across a unit normal: the smallest turn brings the one plane onto the other,
    /// eq. (10). Of the two normals of the triangle the one that looks the same way is meant, whatever its winding.
    Symmetric2 turned(const Frame& frame) const {
        const Vec3 onto = dot(plane, frame.n) < 0 ? -plane : plane, sum = frame.n + onto;
        const double scale = 1 / (1 + dot(frame.n, onto));
        return in(frame.u - (scale * dot(frame.u, onto)) * sum, frame.v - (scale * dot(frame.v, onto)) * sum);
    }
};

/// False where the triangle has no area or anything is undefined.
bool derivative(Vec3 a, Vec3 b, Vec3 da, Vec3 db, Derivative& out) {
    const Vec3 normal = cross(a, b);
    const double cross_squared = squared(normal), half_squares = 0.5 * (squared(a) + squared(b) + squared(b - a));
    if (!std::isfinite(half_squares) || !finite(da) || !finite(db) || no_area(cross_squared, half_squares))
        return false;
    const double scale = 1 / cross_squared, twice_area = std::sqrt(cross_squared);
    out = {da, db, scale * cross(b, normal), scale * cross(normal, a), (1 / twice_area) * normal, 0.5 * twice_area};
    return true;
}

bool derivative(Points vertices, const std::int32_t* face, Points normals, Derivative& out) {
    const Vec3 origin = load(vertices[face[0]]), normal = load(normals[face[0]]);
    return derivative(load(vertices[face[1]]) - origin, load(vertices[face[2]]) - origin,
                      load(normals[face[1]]) - normal, load(normals[face[2]]) - normal, out);
}

/// Looking up whichever way the normal looks, so that turning all normals round changes signs and nothing else.
Frame tangent_frame(Vec3 normal) {
    return frame_about(upward(normal));
}

}  // namespace

PrincipalCurvatures undefined_tensor(std::size_t count) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {std::vector<double>(count, nan), std::vector<double>(count, nan), std::vector<double>(3 * count, nan)};
}

void store(PrincipalCurvatures& tensor, std::size_t i, const Principal& value) {
    tensor.k1[i] = value.k1;
    tensor.k2[i] = value.k2;
    store(&tensor.direction[3 * i], value.direction);
}

void copy(PrincipalCurvatures& tensor, std::size_t from, std::size_t to) {
    store(tensor, to, {tensor.k1[from], tensor.k2[from], load(&tensor.direction[3 * from])});
}

PrincipalCurvatures face_tensor(Points vertices, Triangles faces, Points unit_normals, const Execution& run) {
    PrincipalCurvatures tensor = undefined_tensor(faces.count);
    for_blocks(faces.count, grain, run, [&](std::size_t, std::size_t f, std::size_t last) {
        Derivative d;
        for (; f < last; ++f) {
            if (!derivative(vertices, faces[f], unit_normals, d)) continue;
            const Frame frame = tangent_frame(d.plane);
            store(tensor, f, principal(d.in(frame.u, frame.v), frame));
        }
    });
    return tensor;
}

PrincipalCurvatures vertex_tensor(Points vertices, Triangles faces, Points unit_normals, const Execution& run) {
    const auto parts = [&](std::size_t f, double(&corners)[3][4]) {
        Derivative d;
        if (!derivative(vertices, faces[f], unit_normals, d)) return false;
        for (int corner = 0; corner < 3; ++corner) {
            const Symmetric2 s = d.turned(tangent_frame(load(unit_normals[faces[f][corner]])));
            double* part = corners[corner];
            part[0] = d.area * s.uu, part[1] = d.area * s.uv, part[2] = d.area * s.vv, part[3] = d.area;
        }
        return true;
    };
    const std::vector<double> sums =
        scatter_faces<4>(faces, vertices.count, chunk_faces(faces, vertices.count, run), part_of(run, 0, 0.8), parts);
    PrincipalCurvatures tensor = undefined_tensor(vertices.count);
    for_blocks(vertices.count, grain, part_of(run, 0.8, 1), [&](std::size_t, std::size_t v, std::size_t last) {
        for (; v < last; ++v) {
            const double *sum = &sums[4 * v], scale = 1 / sum[3];
            if (!(sum[3] > 0)) continue;
            store(tensor, v,
                  principal({scale * sum[0], scale * sum[1], scale * sum[2]}, tangent_frame(load(unit_normals[v]))));
        }
    });
    return tensor;
}

Principal fan_tensor(const Neighborhood& corners, bool closed, const double* normals, Vec3 normal, bool align) {
    const Frame frame = tangent_frame(normal);
    const auto change = [&](std::size_t c) {
        const Vec3 other = load(normals + 3 * static_cast<std::size_t>(corners.index[c]));
        return (align && dot(other, normal) < 0 ? -other : other) - normal;
    };
    Symmetric2 sum;
    double area = 0;
    Derivative d;
    for (std::size_t a = 0; a + (closed ? 0 : 1) < corners.count; ++a) {
        const std::size_t b = a + 1 < corners.count ? a + 1 : 0;
        if (!derivative(corners.offset(a), corners.offset(b), change(a), change(b), d)) continue;
        const Symmetric2 s = d.turned(frame);
        sum = {sum.uu + d.area * s.uu, sum.uv + d.area * s.uv, sum.vv + d.area * s.vv};
        area += d.area;
    }
    if (!(area > 0)) return {};
    const double scale = corners.scale / area;
    return principal({scale * sum.uu, scale * sum.uv, scale * sum.vv}, frame);
}

}  // namespace gaussmap
