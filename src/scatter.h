// Sums over the faces of each vertex of values that a function makes for the three corners of a face.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "check.h"
#include "first_touch.h"
#include "parallel.h"

namespace gaussmap {

constexpr std::size_t scatter_batch = 64;

/// Adds N sums a vertex to `sums`. `values(begin, end, corners)` fills double corners[end − begin][3][N] for the faces
/// [begin, end), at most `scatter_batch`; all 0 where a face adds nothing. Contributions are added in ascending order
/// of the faces for any number of threads (first_touch.h). \throw std::invalid_argument at an index outside [0,
/// vertices). \param chunks  of the faces.
template <int N, class Values>
void scatter_batches(Triangles faces, std::size_t vertices, const FaceChunks& chunks, const Execution& run,
                     double* sums, Values&& values) {
    struct Late {
        std::int32_t vertex;
        double value[N];
    };
    constexpr std::size_t stretch = 1 << 14;
    std::vector<std::vector<Late>> late(chunks.count());
    const bool alone = chunks.count() == 1;

    const auto work = [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        double corners[scatter_batch][3][N];
        for (; begin < end; begin += scatter_batch) {
            const std::size_t stop = std::min(end, begin + scatter_batch);
            values(begin, stop, corners);
            const double* value = corners[0][0];
            for (std::size_t i = 3 * begin; i < 3 * stop; ++i, value += N) {
                const std::int32_t vertex = faces.abc[i];
                if (alone || chunks.owner[vertex] == chunk) {
                    double* sum = sums + N * static_cast<std::size_t>(vertex);
                    for (int n = 0; n < N; ++n) sum[n] += value[n];
                } else {
                    Late& l = late[chunk].emplace_back();
                    l.vertex = vertex;
                    std::copy_n(value, N, l.value);
                }
            }
        }
    };
    const auto checked_work = [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        if (chunk + 1 == chunks.count() && !faces_within(faces, begin, end, vertices)) check_faces(faces, vertices);
        work(chunk, begin, end);
    };
    if (alone) {
        for_blocks(faces.count, stretch, {1, run.progress},
                   [&](std::size_t, std::size_t begin, std::size_t end) { checked_work(0, begin, end); });
    } else {
        for_blocks(chunks.count(), 1, run, [&](std::size_t c, std::size_t, std::size_t) {
            for (std::size_t begin = chunks.begin[c]; begin < chunks.begin[c + 1]; begin += stretch)
                checked_work(c, begin, std::min(begin + stretch, chunks.begin[c + 1]));
        });
    }
    for (const auto& list : late)
        for (const Late& l : list)
            for (int i = 0; i < N; ++i) sums[N * static_cast<std::size_t>(l.vertex) + i] += l.value[i];
}

/// The same, of sums that begin with 0.
template <int N, class Values>
std::vector<double> scatter_batches(Triangles faces, std::size_t vertices, const FaceChunks& chunks,
                                    const Execution& run, Values&& values) {
    std::vector<double> sums(N * vertices, 0.0);
    scatter_batches<N>(faces, vertices, chunks, run, sums.data(), values);
    return sums;
}

/// The same, a face at a time: `values(face, corners)` fills double corners[3][N] and returns whether the face adds
/// anything.
template <int N, class Values>
std::vector<double> scatter_faces(Triangles faces, std::size_t vertices, const FaceChunks& chunks, const Execution& run,
                                  Values&& values) {
    return scatter_batches<N>(faces, vertices, chunks, run,
                              [&](std::size_t begin, std::size_t end, double(*corners)[3][N]) {
                                  for (std::size_t f = begin; f < end; ++f)
                                      if (!values(f, corners[f - begin]))
                                          std::fill_n(corners[f - begin][0], 3 * N, 0.0);
                              });
}

}  // namespace gaussmap
