#include "judge.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>

Shape read_shape(const std::string& path) {
    Shape shape{gaussmap::read(path), {}};
    const gaussmap::Property* truth = shape.geometry.vertex_property("exact_density");
    if (truth == nullptr) throw std::invalid_argument(path + ": no vertex property exact_density");
    shape.truth = truth->as_double();
    return shape;
}

void report(const std::string& peer, const std::string& parameter, const std::vector<double>& density,
            const std::vector<double>& truth, double seconds) {
    double tt = 0, dt = 0, dd = 0, ee = 0;
    std::size_t undefined = 0;
    for (std::size_t i = 0; i < density.size(); ++i) {
        if (!std::isfinite(density[i])) {
            ++undefined;
            continue;
        }
        tt += truth[i] * truth[i], dt += density[i] * truth[i], dd += density[i] * density[i];
        ee += (density[i] - truth[i]) * (density[i] - truth[i]);
    }
    const double rescaled = dd > 0 ? std::sqrt(std::max(0.0, tt - dt * dt / dd) / tt) : 1;
    std::printf("%s,%s,%.6g,%.6g,%zu,%zu,%.6g\n", peer.c_str(), parameter.c_str(), std::sqrt(ee / tt), rescaled,
                undefined, density.size(), seconds);
    std::fflush(stdout);
}

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
