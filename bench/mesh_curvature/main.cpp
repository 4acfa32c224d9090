// Speed of the fused per-vertex pass on a sphere of 1.3 M triangles and a torus of 2.6 M: triangles a second, the part
// of the memory's speed that is reached, two threads against one, and the ratio to an implementation written the
// textbook way. All in one run, interleaved, results checked first.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <thread>

#include "gaussmap/curvature.h"
#include "gaussmap/surfaces.h"
#include "peers.h"

using namespace gaussmap;

namespace {

// 12 of indices, 12 + 12 of positions and normals, 8 of sums: compulsory traffic a triangle, two triangles a vertex.
constexpr double bytes_per_triangle = 44;
constexpr std::size_t triad_items = std::size_t{1} << 23;

/// Root mean square error relative to that of the truth; ends the program where a result is not what it should be.
void check(const char* what, const std::vector<double>& density, const Surface& s, double limit) {
    double error = 0, truth = 0;
    for (std::size_t i = 0; i < density.size(); ++i)
        error += std::pow(density[i] - s.density[i], 2), truth += s.density[i] * s.density[i];
    const double relative = std::sqrt(error / truth);
    std::printf("%-28s relative error of the density %.2g\n", what, relative);
    if (!(relative < limit)) std::fprintf(stderr, "%s: wrong result\n", what), std::exit(1);
}

void fused(benchmark::State& state, const Surface& s, int threads) {
    const Points v(s.vertices), n(s.normals);
    const Triangles f(s.faces);
    std::vector<double> density_and_area(2 * v.count);
    for (auto _ : state) vertex_density(v, f, n, density_and_area.data(), {threads, {}});
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * f.count));
}

/// Two passes of one thread each side by side, on meshes of their own: what two threads could reach at best on this
/// machine.
void apart(benchmark::State& state, const Surface& s) {
    const Surface copy = s;
    std::vector<double> first(2 * s.density.size()), second(first.size());
    for (auto _ : state) {
        std::thread other([&] { vertex_density(copy.vertices, copy.faces, copy.normals, second.data(), {1, {}}); });
        vertex_density(s.vertices, s.faces, s.normals, first.data(), {1, {}});
        other.join();
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * 2 * s.faces.size() / 3));
}

/// Everything `gaussmap curvature` does to a mesh but reading and writing: Max's normals, faces and vertices.
void whole(benchmark::State& state, const Surface& s, int threads) {
    MeshCurvatureOptions options;
    options.run.threads = threads;
    for (auto _ : state) benchmark::DoNotOptimize(mesh_curvature(s.vertices, s.faces, {}, options));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * s.faces.size() / 3));
}

void textbook(benchmark::State& state, const Surface& s) {
    const auto mesh = textbook_mesh(s.vertices, s.faces, s.normals);
    for (auto _ : state) benchmark::DoNotOptimize(textbook_density(*mesh));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * s.faces.size() / 3));
}

void memory(benchmark::State& state) {
    std::vector<double> a(triad_items, 0), b(triad_items, 1), c(triad_items, 2);
    for (auto _ : state) triad(a, b, c, 3), benchmark::ClobberMemory();
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * triad_items));
}

/// Keeps the rate of every repetition; the fastest is what the machine can do, the median what it did.
struct Rates : benchmark::BenchmarkReporter {
    std::map<std::string, std::vector<double>> rates;

    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs)
            if (run.run_type == Run::RT_Iteration)
                rates[run.run_name.function_name].push_back(run.counters.at("items_per_second") * 1e-6);
    }
    double best(const std::string& name) {
        std::vector<double>& r = rates[name];
        return r.empty() ? NAN : *std::max_element(r.begin(), r.end());
    }
    double median(const std::string& name) {
        std::vector<double>& r = rates[name];
        std::sort(r.begin(), r.end());
        return r.empty() ? NAN : r[r.size() / 2];
    }
};

void print(Rates& rates) {
    std::printf("\n%-20s %14s %14s   (millions a second)\n", "", "fastest", "median");
    for (const auto& [name, unused] : rates.rates)
        std::printf("%-20s %14.1f %14.1f\n", name.c_str(), rates.best(name), rates.median(name));
}

void summary(Rates& rates, const std::string& name) {
    const double one = rates.best("fused/" + name + "/1"), two = rates.best("fused/" + name + "/2");
    const double limit = rates.best("triad") * 24 / bytes_per_triangle, textbook = rates.best("textbook");
    std::printf(
        "%s: fused pass %.0f M triangles/s on one thread, %.0f %% of the %.0f that the memory allows (triad "
        "%.1f GB/s, %.0f bytes a triangle)\n",
        name.c_str(), one, 100 * one / limit, limit, rates.best("triad") * 24e-3, bytes_per_triangle);
    std::printf(
        "    two threads %.0f: %.2f x one (two separate passes side by side %.2f x); %.0f x the textbook's %.2f\n", two,
        two / one, rates.best("apart") / one, one / textbook, textbook);
}

}  // namespace

int main(int argc, char** argv) {
    const Surface ball = sphere(8), ring = torus(1, 0.5, 1140, 1140);
    const std::pair<const char*, const Surface*> meshes[] = {{"sphere", &ball}, {"torus", &ring}};
    check("sphere, ours", mesh_curvature(ball.vertices, ball.faces, ball.normals).density, ball, 1e-9);
    check("torus, ours", mesh_curvature(ring.vertices, ring.faces, ring.normals).density, ring, 1e-4);
    check("torus, Max's normals", mesh_curvature(ring.vertices, ring.faces).density, ring, 1e-4);
    check("sphere, textbook", textbook_density(*textbook_mesh(ball.vertices, ball.faces, ball.normals)), ball, 1e-6);

    for (const auto& [name, mesh] : meshes)
        for (const int threads : {1, 2}) {
            const std::string suffix = std::string(name) + "/" + std::to_string(threads);
            benchmark::RegisterBenchmark(("fused/" + suffix).c_str(), fused, *mesh, threads)->UseRealTime();
            benchmark::RegisterBenchmark(("whole/" + suffix).c_str(), whole, *mesh, threads)->UseRealTime();
        }
    benchmark::RegisterBenchmark("apart", apart, ring)->UseRealTime();
    benchmark::RegisterBenchmark("textbook", textbook, ball)->UseRealTime()->Repetitions(5);
    benchmark::RegisterBenchmark("triad", memory)->UseRealTime();

    // Interleaved repetitions, so that a slow moment of the machine falls on all alike.
    std::vector<std::string> defaults = {"--benchmark_enable_random_interleaving=true", "--benchmark_repetitions=30",
                                         "--benchmark_min_time=0.001"};
    std::vector<char*> arguments = {argv[0]};
    for (auto& option : defaults) arguments.push_back(option.data());
    arguments.insert(arguments.end(), argv + 1, argv + argc);
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
    Rates rates;
    benchmark::RunSpecifiedBenchmarks(&rates);
    print(rates);
    for (const auto& [name, mesh] : meshes) summary(rates, name);
    return 0;
}
