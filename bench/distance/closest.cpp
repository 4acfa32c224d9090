// closest FROM TO COUNT FOLDER: COUNT random points on the surface FROM, and their closest points on the surface TO.
// Writes vertices.f64 and faces.i32 of TO and queries.f64 into FOLDER, for the peers. For every line on standard input
// measures once more, on one thread, and prints the processor seconds of making the index and of asking it; at the end
// writes distances.f64.

#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "gaussmap/distance.h"
#include "gaussmap/io.h"
#include "gaussmap/sampling.h"

namespace {

template <class Value>
void save(const std::string& path, const std::vector<Value>& values) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(Value)));
}

double processor_seconds() {
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void run(const std::string& from_path, const std::string& to_path, std::size_t count, const std::string& folder) {
    const gaussmap::Execution alone{1, {}};
    const gaussmap::Geometry from = gaussmap::read(from_path), to = gaussmap::read(to_path);
    const std::vector<double> queries =
        gaussmap::sample_surface(from.vertices, from.faces, count, {gaussmap::SamplingMethod::random, 1, {}}).points;
    save(folder + "/vertices.f64", to.vertices);
    save(folder + "/faces.i32", to.faces);
    save(folder + "/queries.f64", queries);
    std::printf("ready\n");
    std::fflush(stdout);
    std::vector<double> distances;
    for (std::string line; std::getline(std::cin, line);) {
        const double begin = processor_seconds();
        const gaussmap::ClosestIndex index(to.vertices, to.faces, alone);
        const double made = processor_seconds();
        distances = index.distances(queries, alone);
        std::printf("%.6f %.6f\n", made - begin, processor_seconds() - made);
        std::fflush(stdout);
    }
    save(folder + "/distances.f64", distances);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5) {
        std::fprintf(stderr, "usage: closest FROM TO COUNT FOLDER\n");
        return 2;
    }
    try {
        run(argv[1], argv[2], std::stoull(argv[3]), argv[4]);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "closest: %s\n", problem.what());
        return 1;
    }
    return 0;
}
