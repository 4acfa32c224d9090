// The fused per-vertex pass: chunks of faces side by side, bits of the serial loop (first_touch.h).
#include "vertex_density.h"

#include <algorithm>

#include "check.h"
#include "first_touch.h"
#include "gaussmap/curvature.h"
#include "instruction_sets.h"
#include "parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t stretch = 1 << 12;  // faces a kernel call
constexpr std::size_t vertex_block = 1 << 12;

const FusedKernel& best_kernel() {
    return GAUSSMAP_FASTEST(fused_kernel);
}

/// The kernel over a chunk that is one of several; returns what it set aside.
std::vector<SetAside> run_chunk(const FusedKernel& kernel, FusedPass pass, Triangles faces, std::size_t vertices,
                                const FaceChunks& chunks, std::size_t c) {
    std::vector<SetAside> aside;
    std::size_t used = 0;
    pass.owner = c == 0 ? nullptr : chunks.owner.data();  // the first chunk owns all that it touches
    pass.chunk = static_cast<std::uint8_t>(c);
    for (std::size_t begin = chunks.begin[c]; begin < chunks.begin[c + 1]; begin += stretch) {
        const std::size_t end = std::min(begin + stretch, chunks.begin[c + 1]);
        if (c + 1 == chunks.count() && !faces_within(faces, begin, end, vertices)) check_faces(faces, vertices);
        if (c > 0 && aside.size() < used + 3 * stretch) aside.resize(2 * used + 3 * stretch);
        pass.aside = aside.data() + used;
        kernel.faces(pass, begin, end);
        used = static_cast<std::size_t>(pass.aside - aside.data());
    }
    aside.resize(used);
    return aside;
}

}  // namespace

void fused_pass(Points vertices, Triangles faces, const FaceChunks& chunks, Points unit_normals, double* sums,
                double* face_kappa, double* face_density, const Execution& run) {
    check_count("normals", unit_normals.count, vertices.count, "vertices");
    const FusedKernel& kernel = best_kernel();
    FusedPass pass{vertices.xyz, unit_normals.xyz, faces.abc, sums, face_kappa, face_density, nullptr, 0, nullptr};
    if (chunks.count() == 1) {
        // Sums are cleared just ahead of the faces that first need them, while both are in the cache.
        std::size_t cleared = 0;
        const auto clear_to = [&](std::size_t end) {
            if (end > cleared) std::fill(sums + 2 * cleared, sums + 2 * end, 0.0);
            cleared = std::max(cleared, end);
        };
        for_blocks(faces.count, stretch, {1, run.progress}, [&](std::size_t, std::size_t begin, std::size_t end) {
            const std::size_t highest = kernel.highest(faces[begin], 3 * (end - begin));
            if (highest >= index_limit(vertices.count)) check_faces(faces, vertices.count);
            clear_to(highest + 1);
            kernel.faces(pass, begin, end);
        });
        clear_to(vertices.count);
        return;
    }
    for_blocks(vertices.count, vertex_block, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::fill(sums + 2 * begin, sums + 2 * end, 0.0);
    });
    std::vector<std::vector<SetAside>> aside(chunks.count());
    for_blocks(chunks.count(), 1, run, [&](std::size_t c, std::size_t, std::size_t) {
        aside[c] = run_chunk(kernel, pass, faces, vertices.count, chunks, c);
    });
    for (const auto& later : aside)
        for (const SetAside& s : later) {
            double* sum = sums + 2 * static_cast<std::size_t>(s.vertex);
            sum[0] += s.kappa, sum[1] += s.area;
        }
}

void divide_sums(double* sums, std::size_t vertices, const Execution& run) {
    for_blocks(vertices, vertex_block, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        best_kernel().divide(sums + 2 * begin, end - begin);
    });
}

void vertex_density(Points vertices, Triangles faces, Points unit_normals, double* density_and_area,
                    const Execution& run) {
    fused_pass(vertices, faces, chunk_faces(faces, vertices.count, run), unit_normals, density_and_area, nullptr,
               nullptr, run);
    divide_sums(density_and_area, vertices.count, run);
}

}  // namespace gaussmap
