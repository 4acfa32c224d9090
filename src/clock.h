// Wall-clock seconds of the stages of a call.
#pragma once

#include <chrono>

namespace gaussmap {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace gaussmap
