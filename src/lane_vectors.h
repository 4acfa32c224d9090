// Vectors of which each lane holds its own. Included by kernels alone, each compiled for its instruction set; nothing
// here may have external linkage.
#pragma once

#include "lane_fits.h"
#include "registers.h"

namespace gaussmap {
namespace {

struct Vector {
    Real x, y, z;
};
GAUSSMAP_INLINE Vector operator+(Vector a, Vector b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
GAUSSMAP_INLINE Vector operator-(Vector a, Vector b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
GAUSSMAP_INLINE Vector operator*(Real s, Vector a) {
    return {s * a.x, s * a.y, s * a.z};
}
GAUSSMAP_INLINE Real dot(Vector a, Vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
GAUSSMAP_INLINE Vector load(const LaneValues (&a)[3], int lane) {
    return {load(&a[0][lane]), load(&a[1][lane]), load(&a[2][lane])};
}

/// The same member of what each lane points to.
template <class Thing, class Value>
GAUSSMAP_INLINE Real gather(const Thing* const (&things)[lanes], Value&& value) {
    Real values;
    for (int l = 0; l < lanes; ++l) values[l] = value(*things[l]);
    return values;
}
template <class Thing>
GAUSSMAP_INLINE Vector gather_vector(const Thing* const (&things)[lanes], double (Thing::*of)[3]) {
    return {gather(things, [&](const Thing& thing) { return (thing.*of)[0]; }),
            gather(things, [&](const Thing& thing) { return (thing.*of)[1]; }),
            gather(things, [&](const Thing& thing) { return (thing.*of)[2]; })};
}

/// The sample of that number about each lane's place, `nothing` where there is none.
template <class Sample>
GAUSSMAP_INLINE void pick(const Sample* samples, const Sample& nothing, const LaneFrames& about, int lane, int number,
                          const Sample* (&picked)[lanes]) {
    for (int l = 0; l < lanes; ++l) {
        const std::int32_t* const from = about.samples[lane + l];
        picked[l] = number < about.count && from != nullptr && from[number * about.stride] >= 0
                        ? samples + from[number * about.stride]
                        : &nothing;
    }
}

}  // namespace
}  // namespace gaussmap
