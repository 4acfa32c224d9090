// Pseudo-random numbers that are the same on every machine; a stream a vertex (or block) keeps them the same for any
// number of threads too.
#pragma once

#include <cmath>
#include <cstdint>

namespace gaussmap {

/// A bijection of 64-bit words in which every input bit changes half of the output bits (the finaliser of SplitMix64:
/// Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators").
inline std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// SplitMix64, started at a place that depends on a seed and on the number of a stream.
class Random {
  public:
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
        : state_(mixed(mixed(seed + increment) + stream * increment)) {}

    std::uint64_t next() { return mixed(state_ += increment); }

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

    /// Uniform in [−1, 1).
    double symmetric() { return 2 * uniform() - 1; }

    /// Normal with mean 0 and standard deviation 1 (Marsaglia's polar method: log and sqrt only, so that the bits
    /// depend on libm as little as can be).
    double normal() {
        for (;;) {
            const double x = symmetric(), y = symmetric(), s = x * x + y * y;
            if (s > 0 && s < 1) return x * std::sqrt(-2 * std::log(s) / s);
        }
    }

  private:
    static constexpr std::uint64_t increment = 0x9e3779b97f4a7c15u;
    std::uint64_t state_;
};

}  // namespace gaussmap
