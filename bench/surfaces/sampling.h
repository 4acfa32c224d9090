// Clouds with exact normals and density, sampled evenly from an analytic surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "gaussmap/surfaces.h"

/// Numbers that are the same with every standard library (its engines are specified, its distributions are not).
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  ///< in [0, 1)
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(uniform() * static_cast<double>(n)); }
    double normal();
    template <class T>
    void shuffle(std::vector<T>& items) {
        for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
    }

  private:
    std::mt19937_64 engine_;
};

/// A dense sample of a surface, each with the area it stands for.
struct Candidates {
    gaussmap::Surface surface;
    std::vector<double> area;
};

/// `count` vertices of the candidates, no two near each other, in random order: 5·count of them drawn by area, then
/// sample elimination.
std::vector<std::size_t> poisson_disk(const Candidates& candidates, std::size_t count, Dice& dice);
