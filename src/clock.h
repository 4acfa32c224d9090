// Wall-clock seconds of the stages of a call.
#pragma once

#include <chrono>

namespace gaussmap {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Times stages that follow each other.
class Lap {
  public:
    /// Add the seconds since the last call, and begin again.
    void add_to(double& seconds) {
        const auto now = Clock::now();
        seconds += std::chrono::duration<double>(now - start_).count();
        start_ = now;
    }
    void restart() { start_ = Clock::now(); }

  private:
    Clock::time_point start_ = Clock::now();
};

}  // namespace gaussmap
