// The point of a triangle closest to a place.
#pragma once

#include "vec.h"

namespace gaussmap {

struct TriangleHit {
    double squared;  ///< distance
    double u, v, w;  ///< weights of the corners a, b, c; 0 exactly on the sides where the closest point lies on one
};

/// By Voronoi regions. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5. Degenerate triangles give a point
/// of theirs.
inline TriangleHit closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const auto hit = [&](double v, double w) { return TriangleHit{squared(ap - v * ab - w * ac), 1 - v - w, v, w}; };
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return hit(0, 0);
    const Vec3 bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {squared(bp), 0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return hit(d1 / (d1 - d3), 0);
    const Vec3 cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {squared(cp), 0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return hit(0, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {squared(bp - w * (c - b)), 0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return sum > 0 ? hit(vb / sum, vc / sum) : hit(0, 0);
}

}  // namespace gaussmap
