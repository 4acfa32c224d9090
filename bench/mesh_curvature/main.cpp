// Speed of the fused per-vertex pass: triangles a second, the part of the memory's speed that is reached, two threads
// against one, and the ratio to an implementation written the textbook way. All measured in one run, interleaved.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

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
    std::vector<double> density(v.count), area(v.count);
    for (auto _ : state) vertex_density(v, f, n, density.data(), area.data(), {threads, {}});
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * f.count));
}

/// Everything `gaussmap curvature` does to a mesh but reading and writing: Max's normals, faces and vertices.
void whole(benchmark::State& state, const Surface& s, int threads) {
    MeshCurvatureOptions options;
    options.run.threads = threads;
    for (auto _ : state) benchmark::DoNotOptimize(mesh_curvature(s.vertices, s.faces, {}, options));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * s.faces.size() / 3));
}

void textbook(benchmark::State& state, const Surface& s) {
    for (auto _ : state) benchmark::DoNotOptimize(textbook_density(s.vertices, s.faces, s.normals));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * s.faces.size() / 3));
}

void memory(benchmark::State& state) {
    std::vector<double> a(triad_items, 0), b(triad_items, 1), c(triad_items, 2);
    for (auto _ : state) triad(a, b, c, 3), benchmark::ClobberMemory();
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * triad_items));
}

/// Prints as usual and keeps the median rate of every benchmark.
struct Medians : benchmark::ConsoleReporter {
    std::map<std::string, double> rate;
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs)
            if (run.run_type == Run::RT_Aggregate && run.aggregate_name == "median")
                rate[run.run_name.function_name] = run.counters.at("items_per_second");
        ConsoleReporter::ReportRuns(runs);
    }
};

void summary(std::map<std::string, double>& rate, const std::string& name, std::size_t triangles) {
    const double one = rate["fused/" + name + "/1"], two = rate["fused/" + name + "/2"];
    const double limit = rate["triad"] * 24 / bytes_per_triangle;
    std::printf(
        "%s, %.2f M triangles: fused pass %.0f M triangles/s on one thread = %.0f %% of the %.0f that the memory "
        "allows (triad %.1f GB/s, %.0f bytes a triangle); two threads %.2f x; %.0f x the textbook's %.2f; "
        "with normals and faces %.0f\n",
        name.c_str(), static_cast<double>(triangles) * 1e-6, one * 1e-6, 100 * one / limit, limit * 1e-6,
        rate["triad"] * 24e-9, bytes_per_triangle, two / one, one / rate["textbook"], rate["textbook"] * 1e-6,
        rate["whole/" + name + "/1"] * 1e-6);
}

}  // namespace

int main(int argc, char** argv) {
    const Surface ball = sphere(8), ring = torus(1, 0.5, 1140, 1140), small = torus(1, 0.5, 150, 100);
    const std::pair<const char*, const Surface*> meshes[] = {{"sphere", &ball}, {"torus", &ring}};
    check("sphere, ours", mesh_curvature(ball.vertices, ball.faces, ball.normals).density, ball, 1e-9);
    check("torus, ours", mesh_curvature(ring.vertices, ring.faces, ring.normals).density, ring, 1e-4);
    check("torus, Max's normals", mesh_curvature(ring.vertices, ring.faces).density, ring, 1e-4);
    check("small torus, textbook", textbook_density(small.vertices, small.faces, small.normals), small, 1e-2);

    for (const auto& [name, mesh] : meshes)
        for (const int threads : {1, 2}) {
            const std::string suffix = std::string(name) + "/" + std::to_string(threads);
            benchmark::RegisterBenchmark(("fused/" + suffix).c_str(), fused, *mesh, threads)->UseRealTime();
            benchmark::RegisterBenchmark(("whole/" + suffix).c_str(), whole, *mesh, threads)->UseRealTime();
        }
    benchmark::RegisterBenchmark("textbook", textbook, small)->UseRealTime();
    benchmark::RegisterBenchmark("triad", memory)->UseRealTime();

    // Interleaved repetitions, so that a slow moment of the machine falls on all alike.
    std::vector<std::string> defaults = {"--benchmark_enable_random_interleaving=true", "--benchmark_repetitions=9",
                                         "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.1"};
    std::vector<char*> arguments = {argv[0]};
    for (auto& option : defaults) arguments.push_back(option.data());
    arguments.insert(arguments.end(), argv + 1, argv + argc);
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
    Medians reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    for (const auto& [name, mesh] : meshes) summary(reporter.rate, name, mesh->faces.size() / 3);
    return 0;
}
