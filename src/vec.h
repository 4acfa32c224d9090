// Three-vectors.
#pragma once

#include <cmath>

namespace gaussmap {

struct Vec3 {
    double x = 0, y = 0, z = 0;
};

inline Vec3 load(const double* p) {
    return {p[0], p[1], p[2]};
}
inline void store(double* p, Vec3 a) {
    p[0] = a.x, p[1] = a.y, p[2] = a.z;
}

inline Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(Vec3 a) {
    return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(double s, Vec3 a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline double dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline double squared(Vec3 a) {
    return dot(a, a);
}
inline double length(Vec3 a) {
    return std::sqrt(squared(a));
}
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline bool finite(Vec3 a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

}  // namespace gaussmap
