// k nearest neighbours of a million points in random order on a torus, by us and by others: nanoseconds a point, tree
// included, and sort included where points are sorted first. Distances are compared with ours before anything is
// timed; repetitions are interleaved.
//
//   knn [points] [repetitions] [k …]      1000000, 3, and 10 20 50 200 unless given
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "gaussmap/neighbors.h"
#include "peers.h"

using namespace gaussmap;

namespace {

struct Method {
    std::string name;
    bool sorts;  ///< points first
    int threads;
    bool slow;  ///< runs once
    std::function<Rows(const std::vector<double>& points, std::size_t k, int threads)> rows;
};

/// Uniformly random in both angles.
std::vector<double> cloud(std::size_t count) {
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
    std::vector<double> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double theta = angle(engine), phi = angle(engine), out = 1 + 0.5 * std::cos(theta);
        points.insert(points.end(), {out * std::cos(phi), out * std::sin(phi), 0.5 * std::sin(theta)});
    }
    return points;
}

std::vector<double> moved(const std::vector<double>& points, const std::vector<std::int32_t>& order) {
    std::vector<double> result(points.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        std::copy_n(points.data() + 3 * static_cast<std::size_t>(order[i]), 3, result.data() + 3 * i);
    return result;
}

/// Neighbours without the point itself, k of them; others find it among theirs, so they are asked for one more.
Rows ours(const std::vector<double>& points, std::size_t k, int threads) {
    return nearest_neighbors(points, static_cast<int>(k) - 1, {threads, {}}).index;
}

/// Of the processor where one thread works, so that other programs disturb less; of the clock on the wall elsewhere.
double seconds(const Method& method, const std::vector<double>& points, std::size_t k) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    if (method.sorts)
        method.rows(moved(points, spatial_order(points, {method.threads, {}})), k + 1, method.threads);
    else
        method.rows(points, k + 1, method.threads);
    if (method.threads == 1) return static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// End the program where the distances of a method are not ours.
void check(const Method& method, const std::vector<double>& points, std::size_t k) {
    const Rows theirs = method.rows(points, k + 1, 1);
    const Neighbors us = nearest_neighbors(points, static_cast<int>(k));
    const auto squared = [&](std::size_t i, std::int32_t j) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c)
            sum += std::pow(points[3 * static_cast<std::size_t>(j) + c] - points[3 * i + c], 2);
        return sum;
    };
    const std::size_t row = theirs.size() / us.count();
    for (std::size_t i = 0; i < us.count(); ++i)
        for (std::size_t j = 0; j < k; ++j)
            if (squared(i, theirs[i * row + j + (row - k)]) != squared(i, us[i][j])) {
                std::fprintf(stderr, "%s, k = %zu: neighbour %zu of point %zu is not ours\n", method.name.c_str(), k, j,
                             i);
                std::exit(1);
            }
}

std::vector<Method> methods() {
    std::vector<Method> all = {{"gaussmap", false, 1, false, ours}, {"gaussmap", false, 2, false, ours}};
    const auto peer = [&](const char* name, auto rows, bool slow) {
        all.push_back({std::string(name) + ", sorted points", true, 1, slow, rows});
        all.push_back({std::string(name) + ", sorted points", true, 2, slow, rows});
        all.push_back({name, false, 1, true, rows});
    };
#ifdef BENCH_NANOFLANN
    peer("nanoflann", nanoflann_rows, false);
#else
    std::puts("nanoflann is not installed");
#endif
#ifdef BENCH_FLANN
    peer("FLANN (PCL)", flann_rows, true);
#else
    std::puts("FLANN is not installed");
#endif
#ifdef BENCH_CGAL
    peer("CGAL", cgal_rows, true);
#else
    std::puts("CGAL is not installed");
#endif
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1000000;
    const int repetitions = argc > 2 ? std::atoi(argv[2]) : 3;
    std::vector<std::size_t> sizes;
    for (int i = 3; i < argc; ++i) sizes.push_back(std::strtoul(argv[i], nullptr, 10));
    if (sizes.empty()) sizes = {10, 20, 50, 200};
    const std::vector<Method> all = methods();
    const std::vector<double> points = cloud(count), some = cloud(20000);
    for (const std::size_t k : sizes) {
        for (const Method& method : all)
            if (method.threads == 1) check(method, some, k);
        std::vector<std::vector<double>> times(all.size());
        for (int r = 0; r < repetitions; ++r)
            for (std::size_t m = 0; m < all.size(); ++m)
                if (r == 0 || !all[m].slow)
                    times[m].push_back(seconds(all[m], points, k) / static_cast<double>(count) * 1e9);
        std::printf("\n%zu points, k = %zu, ns a point %22s %8s %8s %14s\n", count, k, "threads", "fastest", "median",
                    "x gaussmap's");
        for (std::size_t m = 0; m < all.size(); ++m) {
            std::sort(times[m].begin(), times[m].end());
            const double fastest = times[m].front();
            std::printf("    %-40s %7d %8.0f %8.0f %14.2f\n", all[m].name.c_str(), all[m].threads, fastest,
                        times[m][times[m].size() / 2], fastest / times[all[m].threads == 1 ? 0 : 1].front());
        }
        std::fflush(stdout);
    }
    return 0;
}
