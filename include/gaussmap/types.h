// Views, options and errors shared by every gaussmap header. Standard library only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

namespace gaussmap {

/// A view of `count` points (or normals) stored as x y z x y z …, not owned.
/// Any finite magnitude is fine: work is done on differences of coordinates, so a
/// large common offset (UTM metres, say) costs no more accuracy than its storage did.
struct Points {
    const double* xyz = nullptr;
    std::size_t count = 0;

    Points() = default;
    Points(const double* data, std::size_t n) : xyz(data), count(n) {}
    Points(const std::vector<double>& flat) : xyz(flat.data()), count(flat.size() / 3) {}
    Points(std::vector<double>&&) = delete;

    const double* operator[](std::size_t i) const { return xyz + 3 * i; }
    bool empty() const { return count == 0; }
};

/// A view of `count` triangles stored as a b c a b c …, each a vertex index from 0; not owned.
struct Triangles {
    const std::int32_t* abc = nullptr;
    std::size_t count = 0;

    Triangles() = default;
    Triangles(const std::int32_t* data, std::size_t n) : abc(data), count(n) {}
    Triangles(const std::vector<std::int32_t>& flat) : abc(flat.data()), count(flat.size() / 3) {}
    Triangles(std::vector<std::int32_t>&&) = delete;

    const std::int32_t* operator[](std::size_t i) const { return abc + 3 * i; }
    bool empty() const { return count == 0; }
};

/// float32 arrays enter here: `count` values widened to double, exactly.
inline std::vector<double> widen(const float* values, std::size_t count) {
    return std::vector<double>(values, values + count);
}

/// How a call may run. Results are the same bits for any number of threads.
struct Execution {
    /// Number of threads; 0 takes what the machine offers.
    int threads = 0;
    /// Called now and then, from the calling thread, with the fraction done in [0, 1].
    /// Returning false cancels the call, which then throws `Cancelled`.
    std::function<bool(double)> progress;
};

/// Thrown by a call whose `Execution::progress` returned false.
struct Cancelled : std::runtime_error {
    Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace gaussmap
