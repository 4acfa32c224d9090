// The one place that knows about threads: blocks of a range run side by side, exceptions rethrown, progress,
// cancelling.
//
// The blocks depend on the range and the grain alone, never on the number of threads; a body that writes only the slots
// of its own block therefore gives the same bits however many threads run.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>

#include "gaussmap/types.h"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace gaussmap {

/// Threads to use: what was asked for, else what the machine offers.
inline int thread_count(const Execution& run) {
    if (run.threads > 0) return run.threads;
#ifdef _OPENMP
    return std::max(1, omp_get_max_threads());
#else
    return 1;
#endif
}

inline std::size_t block_count(std::size_t count, std::size_t grain) {
    return (count + grain - 1) / grain;
}

/// Call body(block, begin, end) for every block [begin, end) of at most `grain` items of [0, count).
/// The first exception that a body throws is rethrown here, blocks not yet begun being skipped.
/// \throw Cancelled when run.progress returns false.
template <class Body>
void for_blocks(std::size_t count, std::size_t grain, const Execution& run, Body&& body) {
    const std::size_t blocks = block_count(count, grain);
    const auto bounds = [&](std::size_t b) { return std::min(count, (b + 1) * grain); };
    [[maybe_unused]] const int threads = static_cast<int>(std::min<std::size_t>(thread_count(run), blocks));
#ifdef _OPENMP
    if (threads > 1) {
        std::atomic<bool> stop{false}, cancelled{false};
        std::atomic<std::size_t> done{0};
        std::exception_ptr error;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
        for (std::size_t b = 0; b < blocks; ++b) {
            if (stop.load(std::memory_order_relaxed)) continue;
            try {
                body(b, b * grain, bounds(b));
                const std::size_t finished = done.fetch_add(1, std::memory_order_relaxed) + 1;
                if (omp_get_thread_num() == 0 && finished < blocks && run.progress &&
                    !run.progress(static_cast<double>(finished) / static_cast<double>(blocks))) {
                    cancelled = stop = true;
                }
            } catch (...) {
#pragma omp critical(gaussmap_error)
                if (!error) error = std::current_exception();
                stop = true;
            }
        }
        if (error) std::rethrow_exception(error);
        if (cancelled || (run.progress && !run.progress(1))) throw Cancelled();
        return;
    }
#endif
    for (std::size_t b = 0; b < blocks; ++b) {
        body(b, b * grain, bounds(b));
        if (run.progress && !run.progress(static_cast<double>(b + 1) / static_cast<double>(blocks))) throw Cancelled();
    }
}

/// The same run, its progress reported as the part [from, to] of a longer one.
inline Execution part_of(const Execution& run, double from, double to) {
    if (!run.progress) return run;
    return {run.threads, [&run, from, to](double fraction) { return run.progress(from + (to - from) * fraction); }};
}

}  // namespace gaussmap
