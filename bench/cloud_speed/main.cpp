// Speed and memory of clouds on a torus, its points in random order: neighbours alone, and total curvature end to end
// with PCA normals, quadratic and quartic jets, and `auto`, on one thread and on two, against a program built like the
// author's, a textbook's and PCL. All in one run, interleaved, results checked against the truth first.
//
//   cloud_speed [points [repetitions [k]]]            speed; a million points, five repetitions, 20 neighbours
//   cloud_speed memory [points [k]]                   peak memory beyond the input; ten million points
//   cloud_speed author FOLDER [points [queries [k]]]  what the author's parts take and find, for components.py to
//   compare
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <thread>

#include "gaussmap/curvature.h"
#include "peers.h"

using namespace gaussmap;

namespace {

struct Cloud {
    std::vector<double> points, normals, density;

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
    cloud.normals.reserve(3 * count);
    cloud.density.reserve(count);
    for (const std::uint32_t cell : cells) {
        const double theta = turn * (static_cast<double>(cell / columns) + unit(random)) / static_cast<double>(rows);
        const double phi = turn * (static_cast<double>(cell % columns) + unit(random)) / static_cast<double>(columns);
        const double out = 1 + 0.5 * std::cos(theta), k2 = std::cos(theta) / out;
        for (const double v : {out * std::cos(phi), out * std::sin(phi), 0.5 * std::sin(theta)})
            cloud.points.push_back(v);
        for (const double v : {std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), std::sin(theta)})
            cloud.normals.push_back(v);
        cloud.density.push_back(4 + k2 * k2);
    }
    return cloud;
}

/// Root mean square error relative to that of the truth, over the first points where there are no more; ends the
/// program where a result is not what it should be.
void check(const std::string& what, const std::vector<double>& density, const Cloud& cloud, double limit) {
    double error = 0, truth = 0;
    for (std::size_t i = 0; i < density.size(); ++i)
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
    std::function<double()> work = {};  ///< microseconds a point, where `run` is too long to be timed
};

Path path(const char* name, int k, CloudNormals method, int degree, double limit) {
    const auto run = [=](Points points, int threads) {
        CloudCurvatureOptions options;
        options.estimator = Estimator::dirichlet;
        options.k = k;
        options.method = method;
        options.degree = degree;
        options.run.threads = threads;
        return cloud_curvature(points, {}, options).density;
    };
    return {name, limit, run};
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

/// Two runs of one thread each side by side, on clouds of their own: what two threads could reach at best on this
/// machine.
double wall_apart(const Path& path, const Cloud& cloud, const Cloud& copy) {
    const auto start = std::chrono::steady_clock::now();
    std::thread other([&] { path.run(copy.points, 1); });
    path.run(cloud.points, 1);
    other.join();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return seconds.count() * 1e6 / static_cast<double>(2 * cloud.count());
}

/// Microseconds a point of one path, an entry a repetition; the last two for ours alone.
struct Row {
    const Path* path;
    const Cloud* cloud;
    std::vector<double> wall, work, two, apart;
};

void measure(Row& row, const Cloud* copy) {
    if (row.path->work) {
        row.work.push_back(row.path->work());
        row.wall.push_back(row.work.back());
        return;
    }
    const Time one = time_of(*row.path, *row.cloud, 1);
    row.wall.push_back(one.wall);
    row.work.push_back(one.work);
    if (copy == nullptr) return;
    row.two.push_back(time_of(*row.path, *row.cloud, 2).wall);
    row.apart.push_back(wall_apart(*row.path, *row.cloud, *copy));
}

double least(const std::vector<double>& values) {
    return *std::min_element(values.begin(), values.end());
}

double median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) ratios[i] = a[i] / b[i];
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2), ratios.end());
    return ratios[ratios.size() / 2];
}

/// Ratios on one thread are those of the work done, which a busy machine disturbs less than the clock on the wall.
void print_one_thread(const std::vector<Row>& rows) {
    std::printf("\n%-24s %9s %9s %9s %13s\n", "microseconds a point", "wall", "work", "M pts/s", "x neighbours");
    for (const Row& row : rows)
        std::printf("%-24s %9.2f %9.2f %9.3f %13.2f\n", row.path->name.c_str(), least(row.wall), least(row.work),
                    1 / least(row.work), least(row.work) / least(rows[0].work));
}

void print_two_threads(const std::vector<Row>& rows) {
    std::printf("\n%-24s %12s %9s %22s %9s\n", "two threads against one", "of fastest", "median", "apart: of fastest",
                "median");
    for (const Row& row : rows)
        if (!row.two.empty())
            std::printf("%-24s %12.2f %9.2f %22.2f %9.2f\n", row.path->name.c_str(), least(row.wall) / least(row.two),
                        median_ratio(row.wall, row.two), least(row.wall) / least(row.apart),
                        median_ratio(row.wall, row.apart));
}

void print_ratios(const std::vector<Row>& rows) {
    std::printf("\n");
    for (const Row& peer : rows)
        if (peer.two.empty())
            for (const Row& row : rows)
                if (!row.two.empty() && row.path->limit > 0)
                    std::printf("%-20s %6.1f x the rate of %s\n", row.path->name.c_str(),
                                least(peer.work) / least(row.work), peer.path->name.c_str());
}

void print_parts(const std::vector<AuthorWork>& runs) {
    const AuthorWork best = *std::min_element(
        runs.begin(), runs.end(), [](const AuthorWork& a, const AuthorWork& b) { return a.all() < b.all(); });
    std::printf(
        "\nbuilt like the author's: octree %.2f, search %.1f, plane %.1f, triangulation %.1f, energies %.1f: %.1f\n",
        best.octree, best.search, best.plane, best.delaunay, best.energy, best.all());
}

#ifdef BENCH_CGAL
/// The author's program takes normals with the points, and counts a point among its neighbours. Ends the program unless
/// its densities are right, and ours from the same normals wherever its fan is the same: the plane through the
/// neighbours is not quite that of the normal.
void check_author(const Cloud& cloud, const std::vector<double>& density, int k) {
    check("built like the author's", density, cloud, 0.01);
    CloudCurvatureOptions options;
    options.estimator = Estimator::dirichlet;
    options.k = k - 1;
    const std::vector<double> ours = cloud_curvature(cloud.points, cloud.normals, options).density;
    std::size_t equal = 0;
    for (std::size_t i = 0; i < density.size(); ++i) equal += std::abs(density[i] / ours[i] - 1) < 1e-9 ? 1 : 0;
    const double share = static_cast<double>(equal) / static_cast<double>(density.size());
    std::printf("    equal to our fans' with the same normals at %.2f %% of the points\n", 100 * share);
    if (!(share > 0.95)) std::fprintf(stderr, "built like the author's: other fans\n"), std::exit(1);
}
#endif

void measure_speed(std::size_t count, int repetitions, int k) {
    const Cloud cloud = torus_cloud(count), copy = cloud, small = torus_cloud(std::min<std::size_t>(count, 20000)),
                middle = torus_cloud(std::min<std::size_t>(count, 200000));
    const std::vector<Path> ours = our_paths(k);
    std::vector<Path> peers;
    std::vector<Row> rows;
    for (const Path& one : ours) rows.push_back({&one, &cloud, {}, {}, {}, {}});
    std::vector<AuthorWork> author;
#ifdef BENCH_CGAL
    // The search and the fans of some of the points are enough: the cloud is in random order.
    const std::size_t queries = std::min<std::size_t>(count, 5000);
    check_author(cloud, author_cloud(cloud.points, cloud.normals, queries, k).density, k);
    peers.push_back({"built like the author's", 0, {}, [&] {
                         author.push_back(author_cloud(cloud.points, cloud.normals, queries, k).work);
                         return author.back().all();
                     }});
    peers.push_back({"a textbook's means", 0.4, [k](Points points, int) { return textbook_cloud(points, k); }});
#else
    std::printf("CGAL is not installed: no program built like the author's\n");
#endif
#ifdef BENCH_PCL
    peers.push_back({"PCL", 1, [k](Points points, int) { return pcl_cloud(points, k); }});
#else
    std::printf("PCL is not installed: no row\n");
#endif
    for (const Path& one : peers) rows.push_back({&one, one.name == "PCL" ? &middle : &small, {}, {}, {}, {}});
    for (const Row& row : rows)
        if (row.path->limit > 0)
            check(row.path->name, row.path->run(row.cloud->points, 1), *row.cloud, row.path->limit);
    for (int r = 0; r < repetitions; ++r)
        for (Row& row : rows) {
            const bool own = &row - rows.data() < static_cast<std::ptrdiff_t>(ours.size());
            measure(row, own ? &copy : nullptr);
        }
    print_one_thread(rows);
    if (!author.empty()) print_parts(author);
    print_ratios(rows);
    print_two_threads(rows);
}

#ifdef BENCH_CGAL
template <class Value>
void write(const std::filesystem::path& file, const std::vector<Value>& values) {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(Value)));
    if (!out.flush()) std::fprintf(stderr, "%s: cannot write\n", file.c_str()), std::exit(1);
}

/// The parts of the program built like the author's, for the components it is made after to be held against.
void write_author(const std::filesystem::path& folder, std::size_t count, std::size_t queries, int k) {
    const Cloud cloud = torus_cloud(count);
    const AuthorCloud author = author_cloud(cloud.points, cloud.normals, std::min(cloud.count(), queries), k);
    check_author(cloud, author.density, k);
    print_parts({author.work});
    write(folder / "points.f64", cloud.points);
    write(folder / "neighbors.i32", author.neighbors);
    write(folder / "planes.f64", author.planes);
    write(folder / "triangles.i32", author.triangles);
    write(folder / "triangle_counts.i32", author.triangle_counts);
    write(folder / "work.f64", std::vector<double>{author.work.octree, author.work.search, author.work.delaunay});
}
#endif

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
    const std::string verb = argc > 1 ? argv[1] : "";
    const auto number = [&](int place, std::size_t otherwise) {
        return argc > place ? std::strtoull(argv[place], nullptr, 10) : otherwise;
    };
    if (verb == "memory") measure_memory(number(2, 10000000), static_cast<int>(number(3, 20)));
#ifdef BENCH_CGAL
    else if (verb == "author" && argc > 2)
        write_author(argv[2], number(3, 1000000), number(4, 5000), static_cast<int>(number(5, 20)));
#endif
    else
        measure_speed(number(1, 1000000), static_cast<int>(number(2, 5)), static_cast<int>(number(3, 20)));
    return 0;
}
