#include "first_touch.h"

#include <atomic>

#include "check.h"
#include "parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t block = 1 << 14;           // faces looked at in one go
constexpr std::size_t smallest_chunk = 1 << 14;  // below this a second thread costs more than it brings

/// Lower owner[v] to the smallest chunk that touches v. Two threads may race for one vertex and the higher chunk win,
/// so passes are made until one finds nothing to lower. Whatever wins is lower than what stood there before the pass:
/// it ends.
void lower_owners(Triangles faces, FaceChunks& chunks, const Execution& run) {
    const std::size_t last = chunks.count() - 1;
    const std::size_t touched = chunks.begin[last];  // the last chunk owns by default
    std::atomic<bool> again{true};
    // With two chunks only chunk 0 writes: no race, one pass.
    while (again.exchange(false)) {
        for_blocks(touched, block, run, [&](std::size_t, std::size_t begin, std::size_t end) {
            std::size_t chunk = 0;
            bool lowered = false;
            for (std::size_t f = begin; f < end; ++f) {
                while (f >= chunks.begin[chunk + 1]) ++chunk;
                for (int corner = 0; corner < 3; ++corner) {
                    std::atomic_ref<std::uint8_t> owner(chunks.owner[faces[f][corner]]);
                    if (owner.load(std::memory_order_relaxed) <= chunk) continue;
                    owner.store(static_cast<std::uint8_t>(chunk), std::memory_order_relaxed);
                    lowered = true;
                }
            }
            if (lowered && last > 1) again.store(true, std::memory_order_relaxed);
        });
    }
}

}  // namespace

FaceChunks chunk_faces(Triangles faces, std::size_t vertices, const Execution& run) {
    const std::size_t most = std::min<std::size_t>(thread_count(run), 255);
    const std::size_t count = std::max<std::size_t>(1, std::min(most, faces.count / smallest_chunk));
    FaceChunks chunks;
    for (std::size_t c = 0; c <= count; ++c) chunks.begin.push_back(faces.count * c / count);
    const Execution quiet{run.threads, {}};
    std::atomic<bool> bad{false};
    for_blocks(faces.count, block, quiet, [&](std::size_t, std::size_t begin, std::size_t end) {
        if (!faces_within(faces, begin, end, vertices)) bad = true;
    });
    if (bad) check_faces(faces, vertices);
    if (count > 1) {
        chunks.owner.assign(vertices, static_cast<std::uint8_t>(count - 1));
        lower_owners(faces, chunks, quiet);
    }
    return chunks;
}

}  // namespace gaussmap
