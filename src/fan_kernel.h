// Closed fans, as fan.h has them, for one instruction set. Part of cloud_kernel_<set>.cpp alone; nothing here may have
// external linkage.
#pragma once

#include "cloud_kernel.h"
#include "real3.h"

namespace gaussmap {
namespace {

/// The lanes in single precision, and masks or numbers of neighbours beside them.
typedef float Single __attribute__((vector_size(4 * fit_lanes)));
typedef std::int32_t Number __attribute__((vector_size(4 * fit_lanes)));

GAUSSMAP_INLINE Single select(Number mask, Single yes, Single no) {
#ifdef __AVX2__
    return (Single)_mm_blendv_ps((__m128)no, (__m128)yes, (__m128)mask);
#else
    return (Single)((mask & (Number)yes) | (~mask & (Number)no));
#endif
}
GAUSSMAP_INLINE Number select(Number mask, Number yes, Number no) {
    return (Number)select(mask, (Single)yes, (Single)no);
}
GAUSSMAP_INLINE Single absolute(Single a) {
    return (Single)((Number)a & 0x7fffffff);
}
GAUSSMAP_INLINE bool any(Number mask) {
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

/// The inverted projections, eq. (7) of docs/method.md; 0 for neighbours that project onto the centre.
struct Images {
    Single u[most_fitted], v[most_fitted];
    Number nearest;  ///< of the projections
    Single largest;  ///< |u| or |v|, at most; infinite where several are equally near
};

GAUSSMAP_INLINE void invert(const LanePatches& patches, int count, const Real3& n, int lane, Images& images) {
    constexpr double least_squared = 1e-24;  // as in fan.h
    // As `frame_about`.
    const Real sign = (Real)(((Mask)n.z & ~0x7fffffffffffffff) | (Mask)all(1));
    const Real a = -1 / (sign + n.z), b = n.x * n.y * a;
    const Real3 along_u = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, along_v = {b, sign + n.y * n.y * a, -n.y};
    Real least = all(__builtin_inf()), nearest = {}, number = {};
    Mask tied = {};
    for (int j = 0; j < count; ++j, number += 1) {
        const Real3 d = load3(patches.d[j], lane);
        const Real u = dot(d, along_u), v = dot(d, along_v), squared = u * u + v * v;
        const Mask counts = squared > least_squared, nearer = counts & (squared < least);
        tied = (tied & ~nearer) | (squared == least);
        nearest = select(nearer, number, nearest);
        least = select(nearer, squared, least);
        const Real inverse = 1 / squared, image_u = select(counts, u * inverse, Real{}),
                   image_v = select(counts, v * inverse, Real{});
        for (int l = 0; l < lanes; ++l) {
            images.u[j][lane + l] = static_cast<float>(image_u[l]);
            images.v[j][lane + l] = static_cast<float>(image_v[l]);
        }
    }
    // Of several nearest fan.h takes the first by its angle.
    const Real largest = 1 / square_root(select(tied, Real{}, least));
    for (int l = 0; l < lanes; ++l) {
        images.nearest[lane + l] = static_cast<std::int32_t>(nearest[l]);
        images.largest[lane + l] = static_cast<float>(largest[l]);
    }
}

/// The outermost way that the hull could go on, seen from a corner.
struct Way {
    Single u, v;  ///< to another image
    Number number;

    GAUSSMAP_INLINE void take(const Way& other) {
        const Number outer = u * other.v - v * other.u < 0;
        u = select(outer, other.u, u), v = select(outer, other.v, v), number = select(outer, other.number, number);
    }
};

/// The line of an edge of the hull, by its normal, and how many images are not clearly inside of it.
struct Edge {
    Single u, v, limit;
    Number count;

    GAUSSMAP_INLINE void look_at(Single image_u, Single image_v) { count -= u * image_u + v * image_v > limit; }
};

/// The hull of the images by gift wrapping, counterclockwise from the nearest neighbour's, which is a corner. An edge
/// is one where all images but its two ends are clearly inside, and the centre too: beyond the rounding errors of
/// single precision, and beyond what fan.h calls cocircular. Ways that lead nowhere end there; and where the centre is
/// a corner or outside they cannot come back to the first.
///
/// An edge is checked while the next corner is looked for, by two ways in turn: each comparison waits for the last.
GAUSSMAP_INLINE void wrap(const Images& images, int count, LaneFans& fans) {
    // Images are off by 3 · 2⁻²⁴ of their size, so their distances from a line times the length of the edge on it by
    // less than this of the product of sizes.
    constexpr float single_error = 2e-6F, cocircular = 1e-11F;
    const Single largest = images.largest, tolerance = cocircular * largest * largest;
    Number good = tolerance <= __FLT_MAX__, returned = {}, at = images.nearest, corners = {};
    Edge edge = {};
    for (int corner = 0; corner <= fans.most_corners && any(good & ~returned); ++corner) {
        Single u, v;
        for (int l = 0; l < fit_lanes; ++l) {
            fans.chain[corner][l] = at[l];
            u[l] = images.u[at[l]][l], v[l] = images.v[at[l]][l];
        }
        Way way = {-u, -v, images.nearest}, other = way;
        edge.count = Number{};
        Number number = {};
        for (int j = 0; j < count; j += 2, number += 2) {
            way.take({images.u[j] - u, images.v[j] - v, number});
            other.take({images.u[j + 1] - u, images.v[j + 1] - v, number + 1});
            edge.look_at(images.u[j], images.v[j]);
            edge.look_at(images.u[j + 1], images.v[j + 1]);
        }
        way.take(other);
        if (corner > 0) {
            good &= returned | (edge.count == 2);
            corners = select(returned, corners, Number{} + corner);
            returned |= at == images.nearest;
        }
        const Single inside = u * way.v - v * way.u,
                     sizes = 2 * (absolute(u) + absolute(v)) + absolute(way.u) + absolute(way.v),
                     clear = single_error * sizes * largest + tolerance;
        good &= returned | (inside > clear);
        edge = {way.v, -way.u, inside - clear, Number{}};
        at = way.number;
    }
    good &= returned;
    for (int l = 0; l < fit_lanes; ++l) fans.corners[l] = good[l] & corners[l];
}

void closed_fans(const LanePatches& patches, const LaneCounts& counts, const LaneValues (&normal)[3], LaneFans& found) {
    Images images;
    const int count = (most<fit_lanes>(counts, 0) + 1) / 2 * 2;
    for (int lane = 0; lane < fit_lanes; lane += lanes) invert(patches, count, load3(normal, lane), lane, images);
    wrap(images, count, found);
}

}  // namespace
}  // namespace gaussmap
