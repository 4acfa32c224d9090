// The fused per-vertex pass: chunks of faces side by side, bits of the serial loop (first_touch.h).
#include "vertex_density.h"

#include <cmath>
#include <limits>
#include <memory>

#include "check.h"
#include "first_touch.h"
#include "gaussmap/curvature.h"
#include "parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t stretch = 1 << 14;  // faces a kernel call
constexpr std::size_t vertex_block = 1 << 16;

FusedKernel best_kernel() {
#ifdef GAUSSMAP_X86
    if (__builtin_cpu_supports("avx2")) return fused_kernel_avx2;
#endif
    return fused_kernel_baseline;
}

/// Run the kernel over chunk c; returns what it set aside.
std::vector<SetAside> run_chunk(FusedKernel kernel, FusedPass pass, const FaceChunks& chunks, std::size_t c,
                                const Execution& run) {
    std::vector<SetAside> aside;
    std::size_t used = 0;
    pass.owner = chunks.owner.empty() ? nullptr : chunks.owner.data();
    pass.chunk = static_cast<std::uint8_t>(c);
    for (std::size_t begin = chunks.begin[c]; begin < chunks.begin[c + 1]; begin += stretch) {
        const std::size_t end = std::min(begin + stretch, chunks.begin[c + 1]);
        if (c > 0 && aside.size() < used + 3 * stretch) aside.resize(2 * used + 3 * stretch);
        pass.aside = aside.data() + used;
        kernel(pass, begin, end);
        used = static_cast<std::size_t>(pass.aside - aside.data());
        if (chunks.count() == 1 && run.progress &&
            !run.progress(static_cast<double>(end) / static_cast<double>(chunks.begin.back())))
            throw Cancelled();
    }
    aside.resize(used);
    return aside;
}

}  // namespace

void fused_pass(Points vertices, Triangles faces, Points unit_normals, double* sums, double* face_kappa,
                double* face_density, const Execution& run) {
    check_count("normals", unit_normals.count, vertices.count, "vertices");
    const FaceChunks chunks = chunk_faces(faces, vertices.count, run);
    for_blocks(vertices.count, vertex_block, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::fill(sums + 2 * begin, sums + 2 * end, 0.0);
    });
    static const FusedKernel kernel = best_kernel();
    const FusedPass pass{vertices.xyz, unit_normals.xyz, faces.abc, sums,   face_kappa,
                         face_density, nullptr,          0,         nullptr};
    std::vector<std::vector<SetAside>> aside(chunks.count());
    for_blocks(chunks.count(), 1, chunks.count() > 1 ? run : Execution{1, {}},
               [&](std::size_t c, std::size_t, std::size_t) { aside[c] = run_chunk(kernel, pass, chunks, c, run); });
    for (const auto& later : aside)
        for (const SetAside& s : later) sums[2 * s.vertex] += s.kappa, sums[2 * s.vertex + 1] += s.area;
}

void vertex_density(Points vertices, Triangles faces, Points unit_normals, double* density, double* area,
                    const Execution& run) {
    const auto sums = std::make_unique_for_overwrite<double[]>(2 * vertices.count);
    fused_pass(vertices, faces, unit_normals, sums.get(), nullptr, nullptr, run);
    for_blocks(vertices.count, vertex_block, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const double twice_area = sums[2 * v + 1], quotient = sums[2 * v] / twice_area;
            density[v] = twice_area > 0 ? quotient : std::numeric_limits<double>::quiet_NaN();
            area[v] = 0.5 * twice_area;
        }
    });
}

}  // namespace gaussmap
