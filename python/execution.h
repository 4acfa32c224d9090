// How a call from Python runs: without the interpreter's lock, listening for Ctrl-C, reporting progress.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <exception>

#include "gaussmap/types.h"

namespace binding {

namespace nb = nanobind;

/// Looks for signals and reports to a Python callable, a few times a second, while the lock is not held.
class Watch {
  public:
    /// `report` is None, or called with the fraction done; it cancels by returning False or by raising.
    explicit Watch(nb::object report) : report_(std::move(report)) {}

    gaussmap::Execution run(int threads) {
        return {threads, [this](double fraction) { return look(fraction); }};
    }
    /// Throw what Python raised while it was looked at, if anything.
    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
    }

  private:
    using Clock = std::chrono::steady_clock;
    bool look(double fraction);

    nb::object report_;
    std::exception_ptr error_;
    Clock::time_point looked_ = Clock::now();
};

/// work(execution) without the lock. What Python raised meanwhile (KeyboardInterrupt too) is raised again.
template <class Work>
auto released(int threads, const nb::object& progress, Work&& work) {
    Watch watch(progress);
    try {
        const nb::gil_scoped_release release;
        return work(watch.run(threads));
    } catch (const gaussmap::Cancelled&) {
        watch.rethrow();
        throw;
    }
}

}  // namespace binding
