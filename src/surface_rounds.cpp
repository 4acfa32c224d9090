#include "surface_rounds.h"

#include <cmath>
#include <cstddef>

#include "gaussmap/distance.h"
#include "parallel.h"
#include "surface_fit.h"
#include "surface_peaks.h"

namespace gaussmap {
namespace {

constexpr int rounds = 7;
constexpr int last_swaps = 5;        ///< rounds that swap vertices; the others let the fit settle
constexpr double swap_share = 0.05;  ///< of the vertices, at most, in one round

double rms(const FitSamples& samples) {
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < samples.point.size(); ++i)
        sum += samples.area[i] * samples.squared_distance[i], area += samples.area[i];
    return sum > 0 ? std::sqrt(sum / area) : 0;
}

}  // namespace

void bring_nearer(RingMesh& coarse, const DecimationInput& in, const std::vector<std::int32_t>& joined,
                  DecimationObjective objective, const Execution& run) {
    if (coarse.face_count() == 0) return;
    FitSamples samples = samples_of(in.positions, in.corners, joined, coarse);
    FitNorm norm;
    for (int round = 0; round < rounds; ++round) {
        const double size = rms(samples);
        if (size == 0) return;
        norm.scale = 1 / size;
        if (objective == DecimationObjective::max && round >= last_swaps - 1) norm.power = 3;
        move_vertices(coarse, samples, norm, run);
        assign(coarse, samples, run);
        flip_sides(coarse, samples, norm);
        if (round < last_swaps) swap_vertices(coarse, samples, norm, swap_share);
        if (run.progress && !run.progress((round + 1.0) / (rounds + 1))) throw Cancelled();
    }
    if (objective == DecimationObjective::rms) return;
    const std::vector<double> flat = in.flat();
    const ClosestIndex fine(flat, in.corners, {run.threads, {}});
    const std::size_t most_steps = 256 + coarse.face_count() / 16;
    for (int pass = 0; pass < 3; ++pass) {
        if (lower_peaks(coarse, samples, fine, most_steps, run) == 0) break;
        assign(coarse, samples, run);
    }
}

}  // namespace gaussmap
