#include "normalize.h"

#include <cmath>
#include <limits>

#include "parallel.h"
#include "vec.h"

namespace gaussmap {
namespace {

constexpr std::size_t block = 1 << 15;

Vec3 divided(Vec3 v, double by) { return {v.x / by, v.y / by, v.z / by}; }

/// By division, not by a reciprocal: a vector along an axis becomes exactly that axis, so that the normals of a plane in
/// z = const agree to the last bit. Where the square of the length would over- or underflow, the largest coordinate is
/// divided out first.
Vec3 unit(Vec3 v) {
    const double plain = squared(v);
    if (plain > 1e-200 && plain < 1e200) return divided(v, std::sqrt(plain));
    const double largest = std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
    const Vec3 scaled = divided(v, largest);  // NaN for a zero, infinite or NaN vector
    return divided(scaled, length(scaled));
}

}  // namespace

void normalize(std::vector<double>& vectors, const Execution& run) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for_blocks(vectors.size() / 3, block, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 n = unit(load(&vectors[3 * i]));
            store(&vectors[3 * i], finite(n) ? n : Vec3{nan, nan, nan});
        }
    });
}

}  // namespace gaussmap
