// What the tests share: where the real files are, and a fixed source of random numbers.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace support {

/// Everything takes ten times as long and more: where a test draws much at random, or goes through many files, a part
/// is enough to walk every path.
#ifdef GAUSSMAP_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

inline std::filesystem::path data_folder() {
    return GAUSSMAP_DATA;
}

/// In a test: skip with a clear word where the real files are absent.
#define NEED_DATA()                                             \
    if (!std::filesystem::is_directory(support::data_folder())) \
    GTEST_SKIP() << "no folder of real files (set GAUSSMAP_DATA when configuring)"

/// SplitMix64: the same numbers on every machine.
struct Random {
    std::uint64_t state;
    explicit Random(std::uint64_t seed) : state(seed) {}
    std::uint64_t next() {
        std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    double normal() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * std::numbers::pi * uniform()); }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(next() % n); }
};

/// A rotation matrix from a random unit quaternion, row by row.
inline std::vector<double> random_rotation(Random& random) {
    double q[4], s = 0;
    for (double& v : q) v = random.normal(), s += v * v;
    for (double& v : q) v /= std::sqrt(s);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

/// Every point times a 3×3 matrix.
inline std::vector<double> times(const std::vector<double>& matrix, const std::vector<double>& points) {
    std::vector<double> out(points.size());
    for (std::size_t i = 0; i < points.size(); i += 3)
        for (int r = 0; r < 3; ++r)
            out[i + r] =
                matrix[3 * r] * points[i] + matrix[3 * r + 1] * points[i + 1] + matrix[3 * r + 2] * points[i + 2];
    return out;
}

/// Root mean square of a − b over where both are numbers.
inline double rmse(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    std::size_t n = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::isfinite(a[i]) && std::isfinite(b[i])) sum += (a[i] - b[i]) * (a[i] - b[i]), ++n;
    return n ? std::sqrt(sum / static_cast<double>(n)) : NAN;
}

/// Same length and the same bits, NaN equal to NaN.
inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && (a.empty() || std::equal(reinterpret_cast<const unsigned char*>(a.data()),
                                                            reinterpret_cast<const unsigned char*>(a.data() + a.size()),
                                                            reinterpret_cast<const unsigned char*>(b.data())));
}

}  // namespace support
