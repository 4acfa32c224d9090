#include "surface_rounds.h"

#include "parallel.h"
#include "surface_fit.h"
#include "surface_peaks.h"

namespace gaussmap {
namespace {

constexpr int flip_rounds = 2;  ///< the first, that flip; later there is next to nothing to gain
constexpr int both_rounds = 3;  ///< as many as are worth their time
constexpr int more_rounds = 2;  ///< where one distance alone is wanted; if the greatest, it counts more in these

}  // namespace

void bring_nearer(RingMesh& coarse, const DecimationInput& in, const FaceBoxes& fine,
                  const std::vector<std::int32_t>& joined, DecimationObjective objective, const Execution& run) {
    if (coarse.face_count() == 0) return;
    const std::size_t faces = coarse.face_count();
    AreaSamples samples = area_samples(in, joined, coarse, run);
    const int rounds = both_rounds + (objective == DecimationObjective::both ? 0 : more_rounds);
    for (int round = 0; round < rounds && samples.rms > 0; ++round) {
        FitNorm norm;
        norm.scale = 1 / samples.rms;
        if (objective == DecimationObjective::max && round >= both_rounds) norm.power = 3;
        const FaceSamples rows = by_face(samples, faces);
        move_vertices(coarse, samples, rows, norm, run);
        assign(coarse, samples, rows, run);
        if (round < flip_rounds) flip_sides(coarse, samples, norm, run);
        if (run.progress && !run.progress((round + 1.0) / (rounds + 1))) throw Cancelled();
    }
    if (samples.rms == 0 || objective == DecimationObjective::rms) return;
    VertexSamples vertices = vertex_samples(in, samples, coarse, run);
    lower_peaks(coarse, samples, vertices, fine, run);
}

}  // namespace gaussmap
