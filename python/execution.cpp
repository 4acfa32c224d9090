#include "execution.h"

namespace binding {

bool Watch::look(double fraction) {
    // Often enough for a person, seldom enough to cost nothing.
    constexpr auto interval = std::chrono::milliseconds(50);
    const Clock::time_point now = Clock::now();
    if (now - looked_ < interval) return true;
    looked_ = now;
    const nb::gil_scoped_acquire hold;
    try {
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
        return report_.is_none() || !report_(fraction).is(nb::handle(Py_False));
    } catch (...) {
        error_ = std::current_exception();
        return false;
    }
}

}  // namespace binding
