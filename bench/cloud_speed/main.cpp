// Speed and memory of clouds on a torus, its points in random order: neighbours alone, and total curvature end to end
// with PCA normals, quadratic and quartic jets, on one thread and on two, against a program built like the author's and
// PCL. All in one run, interleaved, results checked against the truth first.
//
//   cloud_speed [points [repetitions [k]]]   speed; a million points, five repetitions, 20 neighbours
//   cloud_speed memory [points [k]]          peak memory beyond the input; ten million points
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "gaussmap/curvature.h"
#include "peers.h"

using namespace gaussmap;

namespace {

struct Cloud {
    std::vector<double> points, density;

    std::size_t count() const { return density.size(); }
};

/// Points anywhere in the middle halves of nearly square cells of a torus, shuffled.
Cloud torus_cloud(std::size_t about) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0.25, 0.75);
    const double turn = 2 * std::numbers::pi;
    const auto rows = static_cast<std::size_t>(std::sqrt(static_cast<double>(about) / 2));
    const std::size_t columns = about / rows, count = rows * columns;
    std::vector<std::uint32_t> cells(count);
    for (std::size_t i = 0; i < count; ++i) cells[i] = static_cast<std::uint32_t>(i);
    std::shuffle(cells.begin(), cells.end(), random);
    Cloud cloud;
    cloud.points.reserve(3 * count);
    cloud.density.reserve(count);
    for (const std::uint32_t cell : cells) {
        const double theta = turn * (static_cast<double>(cell / columns) + unit(random)) / static_cast<double>(rows);
        const double phi = turn * (static_cast<double>(cell % columns) + unit(random)) / static_cast<double>(columns);
        const double out = 1 + 0.5 * std::cos(theta), k2 = std::cos(theta) / out;
        for (const double v : {out * std::cos(phi), out * std::sin(phi), 0.5 * std::sin(theta)})
            cloud.points.push_back(v);
        cloud.density.push_back(4 + k2 * k2);
    }
    return cloud;
}

/// Root mean square error relative to that of the truth; ends the program where a result is not what it should be.
void check(const std::string& what, const std::vector<double>& density, const Cloud& cloud, double limit) {
    double error = 0, truth = 0;
    for (std::size_t i = 0; i < cloud.count(); ++i)
        error += std::pow(density[i] - cloud.density[i], 2), truth += cloud.density[i] * cloud.density[i];
    const double relative = std::sqrt(error / truth);
    std::printf("%-28s relative error of the density %.2g\n", what.c_str(), relative);
    if (!(relative < limit)) std::fprintf(stderr, "%s: wrong result\n", what.c_str()), std::exit(1);
}

/// A way to the result; of neighbours alone there is none.
struct Path {
    std::string name;
    double limit;  ///< of the relative error
    std::function<std::vector<double>(Points, int threads)> run;
};

Path path(const char* name, int k, CloudNormals method, int degree, double limit) {
    return {name, limit, [=](Points points, int threads) {
                CloudCurvatureOptions options;
                options.estimator = Estimator::dirichlet;
                options.k = k;
                options.method = method;
                options.degree = degree;
                options.run.threads = threads;
                return cloud_curvature(points, {}, options).density;
            }};
}

std::vector<Path> our_paths(int k) {
    return {{"neighbours alone", 0,
             [k](Points points, int threads) {
                 nearest_neighbors(points, k, {threads, {}});
                 return std::vector<double>();
             }},
            path("PCA + fan", k, CloudNormals::pca, 1, 0.4),
            path("quadratic jets + fan", k, CloudNormals::jet, 2, 0.01),
            path("quartic jets + fan", k, CloudNormals::jet, 4, 0.01),
            {"auto", 0.001, [](Points points, int threads) {
                 CloudCurvatureOptions options;
                 options.run.threads = threads;
                 return cloud_curvature(points, {}, options).density;
             }}};
}

/// Microseconds a point, by the clock on the wall and of all threads' work together.
struct Time {
    double wall, work;
};

Time time_of(const Path& path, const Cloud& cloud, int threads) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t work = std::clock();
    path.run(cloud.points, threads);
    const double per_point = 1e6 / static_cast<double>(cloud.count());
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return {seconds.count() * per_point, static_cast<double>(std::clock() - work) / CLOCKS_PER_SEC * per_point};
}

struct Row {
    const Path* path;
    const Cloud* cloud;
    int threads;
    Time best = {HUGE_VAL, HUGE_VAL};
};

/// Ratios on one thread are those of the work done, which a busy machine disturbs less than the clock on the wall.
void print(const std::vector<Row>& rows) {
    std::printf("\n%-24s %7s %9s %9s %9s %13s %13s\n", "microseconds a point", "threads", "wall", "work", "M pts/s",
                "x neighbours", "x one thread");
    for (const Row& row : rows) {
        std::printf("%-24s %7d %9.2f %9.2f %9.3f", row.path->name.c_str(), row.threads, row.best.wall, row.best.work,
                    1 / (row.threads == 1 ? row.best.work : row.best.wall));
        if (row.threads == 1) std::printf(" %13.2f", row.best.work / rows[0].best.work);
        if (row.threads == 2) std::printf(" %13s %13.2f", "", (&row - 1)->best.wall / row.best.wall);
        std::printf("\n");
    }
    const auto work_of = [&](const std::string& name) {
        const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.path->name == name; });
        return row == rows.end() ? std::nan("") : row->best.work;
    };
    for (const char* peer : {"built like the author's", "PCL"})
        std::printf("quadratic jets + fan: %.1f x the rate of %s\n", work_of(peer) / work_of("quadratic jets + fan"),
                    peer);
}

void measure_speed(std::size_t count, int repetitions, int k) {
    const Cloud cloud = torus_cloud(count), small = torus_cloud(std::min<std::size_t>(count, 20000)),
                middle = torus_cloud(std::min<std::size_t>(count, 200000));
    const std::vector<Path> ours = our_paths(k);
    std::vector<Path> peers;
    std::vector<Row> rows;
    for (const Path& one : ours)
        for (const int threads : {1, 2}) rows.push_back({&one, &cloud, threads});
#ifdef BENCH_TEXTBOOK
    peers.push_back({"built like the author's", 0.4, [k](Points points, int) { return textbook_cloud(points, k); }});
#else
    std::printf("CGAL is not installed: no program built like the author's\n");
#endif
#ifdef BENCH_PCL
    peers.push_back({"PCL", 1, [k](Points points, int) { return pcl_cloud(points, k); }});
#else
    std::printf("PCL is not installed: no row\n");
#endif
    for (const Path& one : peers) rows.push_back({&one, one.name == "PCL" ? &middle : &small, 1});
    for (const Row& row : rows)
        if (row.path->limit > 0 && row.threads == 1)
            check(row.path->name, row.path->run(row.cloud->points, 1), *row.cloud, row.path->limit);
    for (int r = 0; r < repetitions; ++r)
        for (Row& row : rows) {
            const Time time = time_of(*row.path, *row.cloud, row.threads);
            row.best = {std::min(row.best.wall, time.wall), std::min(row.best.work, time.work)};
        }
    print(rows);
}

/// Kilobytes in /proc/self/status.
double status(const char* key) {
    double value = 0;
    char line[256];
    std::FILE* file = std::fopen("/proc/self/status", "r");
    while (file != nullptr && std::fgets(line, sizeof line, file) != nullptr)
        if (std::strncmp(line, key, std::strlen(key)) == 0) value = std::atof(line + std::strlen(key));
    if (file != nullptr) std::fclose(file);
    return value;
}

/// Each way in a process of its own: the peak of its resident memory above what is resident when it begins, the input.
void measure_memory(std::size_t count, int k) {
    const Cloud cloud = torus_cloud(count);
    std::printf("%zu points: peak memory beyond the input, bytes a point\n", cloud.count());
    std::vector<Path> ways = our_paths(k);
    ways.push_back({"the same, spanning tree", 0, [k](Points points, int threads) {
                        CloudCurvatureOptions options;
                        options.estimator = Estimator::dirichlet;
                        options.k = k;
                        options.degree = 2;
                        options.orientation = Orientation::mst;
                        options.run.threads = threads;
                        return cloud_curvature(points, {}, options).density;
                    }});
    for (const Path& one : ways) {
        std::fflush(stdout);
        const pid_t child = fork();
        if (child == 0) {
            const double before = status("VmRSS:");
            const auto start = std::chrono::steady_clock::now();
            one.run(cloud.points, 1);
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
            std::printf("%-24s %6.1f   (%.1f s)\n", one.name.c_str(),
                        (status("VmHWM:") - before) * 1024 / static_cast<double>(cloud.count()), seconds.count());
            std::fflush(stdout);
            _exit(0);
        }
        int state = 0;
        if (child < 0 || waitpid(child, &state, 0) != child || state != 0)
            std::fprintf(stderr, "%s: failed\n", one.name.c_str()), std::exit(1);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    const bool memory = argc > 1 && std::string(argv[1]) == "memory";
    const auto number = [&](int place, std::size_t otherwise) {
        return argc > place ? std::strtoull(argv[place], nullptr, 10) : otherwise;
    };
    if (memory)
        measure_memory(number(2, 10000000), static_cast<int>(number(3, 20)));
    else
        measure_speed(number(1, 1000000), static_cast<int>(number(2, 5)), static_cast<int>(number(3, 20)));
    return 0;
}
