#include "first_touch.h"

#include <atomic>

#include "check.h"
#include "parallel.h"

namespace gaussmap {
namespace {

constexpr std::size_t block = 1 << 14;           // faces looked at in one go
constexpr std::size_t smallest_chunk = 1 << 14;  // below this a second thread costs more than it brings

/// Lower the owners of the vertices first … last to `chunk`; whether any was higher.
bool lower_owners(const std::int32_t* first, const std::int32_t* last, std::uint8_t chunk, std::uint8_t* owner) {
    bool lowered = false;
    for (; first != last; ++first) {
        std::atomic_ref<std::uint8_t> o(owner[*first]);
        if (o.load(std::memory_order_relaxed) <= chunk) continue;
        o.store(chunk, std::memory_order_relaxed);
        lowered = true;
    }
    return lowered;
}

/// Chunk 0 takes all that it touches: with two chunks nobody else writes, and nothing needs to be looked at first.
void claim(const std::int32_t* first, const std::int32_t* last, std::uint8_t* owner) {
    for (; first != last; ++first) std::atomic_ref<std::uint8_t>(owner[*first]).store(0, std::memory_order_relaxed);
}

/// Lower the owners of the vertices of faces [begin, end), which may lie in several chunks; whether any was higher.
bool lower_owners(Triangles faces, FaceChunks& chunks, std::size_t begin, std::size_t end) {
    bool lowered = false;
    std::uint8_t chunk = 0;
    while (begin < end) {
        while (begin >= chunks.begin[chunk + 1]) ++chunk;
        const std::size_t stop = std::min(end, chunks.begin[chunk + 1]);
        lowered |= lower_owners(faces.abc + 3 * begin, faces.abc + 3 * stop, chunk, chunks.owner.data());
        begin = stop;
    }
    return lowered;
}

}  // namespace

FaceChunks chunk_faces(Triangles faces, std::size_t vertices, const Execution& run) {
    const std::size_t most = std::min<std::size_t>(thread_count(run), 255);
    const std::size_t count = std::max<std::size_t>(1, std::min(most, faces.count / smallest_chunk));
    FaceChunks chunks;
    for (std::size_t c = 0; c <= count; ++c) chunks.begin.push_back(faces.count * c / count);
    if (count == 1) return chunks;
    const std::size_t last = count - 1;  // the last chunk owns what no other touches
    chunks.owner.assign(vertices, static_cast<std::uint8_t>(last));

    // Faces are checked and, while they are in the cache, their vertices claimed. Two threads may race for one vertex
    // and the higher chunk win, so with three chunks or more passes are made until one finds nothing to lower. Whatever
    // wins is lower than what stood there before the pass: it ends.
    std::atomic<bool> bad{false}, again{true};
    while (again.exchange(false)) {
        for_blocks(chunks.begin[last], block, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
            if (!faces_within(faces, begin, end, vertices)) {
                bad = true;
            } else if (last == 1) {
                claim(faces.abc + 3 * begin, faces.abc + 3 * end, chunks.owner.data());
            } else if (lower_owners(faces, chunks, begin, end)) {
                again.store(true, std::memory_order_relaxed);
            }
        });
        if (bad) check_faces(faces, vertices);
    }
    return chunks;
}

}  // namespace gaussmap
