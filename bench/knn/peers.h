// Exact k nearest neighbours by others. Each builds its tree by one thread, as its library does, and searches by some.
#pragma once

#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

/// n rows of k indices: the neighbours of every point, itself among them, nearest first.
using Rows = std::vector<std::int32_t>;

#ifdef BENCH_NANOFLANN
Rows nanoflann_rows(const std::vector<double>& points, std::size_t k, int threads);
#endif
#ifdef BENCH_FLANN
Rows flann_rows(const std::vector<double>& points, std::size_t k, int threads);
#endif
#ifdef BENCH_CGAL
Rows cgal_rows(const std::vector<double>& points, std::size_t k, int threads);
#endif

/// Call body(begin, end) for equal parts of [0, count), one a thread.
template <class Body>
void share(std::size_t count, int threads, Body&& body) {
    const std::size_t parts = static_cast<std::size_t>(threads);
    std::vector<std::thread> others;
    for (std::size_t t = 1; t < parts; ++t)
        others.emplace_back([&, t] { body(count * t / parts, count * (t + 1) / parts); });
    body(0, count / parts);
    for (std::thread& thread : others) thread.join();
}
