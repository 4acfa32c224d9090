#include "normalize.h"

#include "frame.h"
#include "parallel.h"

namespace gaussmap {

void normalize(std::vector<double>& vectors, const Execution& run) {
    constexpr std::size_t block = 1 << 12;
    for_blocks(vectors.size() / 3, block, {run.threads, {}}, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) store(&vectors[3 * i], unit(load(&vectors[3 * i])));
    });
}

}  // namespace gaussmap
