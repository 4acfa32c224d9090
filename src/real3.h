// Three-vectors of lanes. Part of the kernels that include it, as registers.h is.
#pragma once

#include "cloud_kernel.h"
#include "registers.h"

namespace gaussmap {
namespace {

struct Real3 {
    Real x, y, z;
};

GAUSSMAP_INLINE Real3 load3(const LaneValues (&v)[3], int lane) {
    return {load(&v[0][lane]), load(&v[1][lane]), load(&v[2][lane])};
}
GAUSSMAP_INLINE void store3(LaneValues (&v)[3], int lane, const Real3& a) {
    store(&v[0][lane], a.x), store(&v[1][lane], a.y), store(&v[2][lane], a.z);
}
GAUSSMAP_INLINE Real3 operator+(const Real3& a, const Real3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
GAUSSMAP_INLINE Real3 operator-(const Real3& a, const Real3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
GAUSSMAP_INLINE Real3 operator-(const Real3& a) {
    return {-a.x, -a.y, -a.z};
}
GAUSSMAP_INLINE Real3 operator*(Real s, const Real3& a) {
    return {s * a.x, s * a.y, s * a.z};
}
GAUSSMAP_INLINE Real dot(const Real3& a, const Real3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
GAUSSMAP_INLINE Real squared(const Real3& a) {
    return dot(a, a);
}
GAUSSMAP_INLINE Real3 cross(const Real3& a, const Real3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
GAUSSMAP_INLINE Real3 select(Mask mask, const Real3& yes, const Real3& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
GAUSSMAP_INLINE Real absolute(Real a) {
    return (Real)((Mask)a & 0x7fffffffffffffff);
}
/// As `unit` of frame.h.
GAUSSMAP_INLINE Real3 unit(const Real3& a) {
    const Real largest = maximum(absolute(a.x), maximum(absolute(a.y), absolute(a.z)));
    const Real3 b = {a.x / largest, a.y / largest, a.z / largest};
    return (1 / square_root(squared(b))) * b;
}

/// The largest of the counts of a group of lanes, and they themselves.
template <int Lanes = lanes>
GAUSSMAP_INLINE int most(const LaneCounts& counts, int lane) {
    int last = counts[lane];
    for (int l = 1; l < Lanes; ++l) last = counts[lane + l] > last ? counts[lane + l] : last;
    return last;
}
GAUSSMAP_INLINE Real counted(const LaneCounts& counts, int lane) {
    Real count;
    for (int l = 0; l < lanes; ++l) count[l] = counts[lane + l];
    return count;
}

}  // namespace
}  // namespace gaussmap
