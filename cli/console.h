// What a person at the terminal sees: standard error, the progress bar, colour; and how a run ends.
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "gaussmap/types.h"

namespace cli {

enum class Exit { done = 0, failed = 1, wrong_usage = 2, bad_input = 3 };

/// Ends the run: one line on standard error and this exit code.
struct Failure : std::runtime_error {
    Failure(Exit code_, const std::string& line) : std::runtime_error(line), code(code_) {}
    Exit code;
};

/// Standard error is a terminal that may be drawn on: bar and colour (NO_COLOR and TERM=dumb say no).
bool may_draw();

/// The text in bold where colour is allowed.
std::string bold(std::string_view text);

/// Write text to standard error. A person who closed it is not told so.
void say(std::string_view text);

/// Write text to standard output. \throw Failure when it does not all get there (a full disk, a closed pipe).
void put(std::string_view text);

/// "gaussmap: " and the failure on one line, whatever it holds (control characters of file names become '?').
void complain(std::string_view line);

/// " (did you mean 'x'?)"-style ending: "; did you mean 'x'?" for the closest of the words, or nothing where none is
/// close.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& words);

/// A bar on standard error for work over about a second; nothing where it may not be drawn.
class Progress {
  public:
    /// `what` names the work, "reading"; not shown where `quiet`.
    Progress(std::string what, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// How a library call is to run so that it drives this bar, which must outlive the call.
    gaussmap::Execution run(int threads);

  private:
    using Clock = std::chrono::steady_clock;
    void draw(double fraction);

    std::string what_;
    bool shown_;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point drawn_ = begin_;
};

/// Ctrl-C, SIGTERM and SIGHUP end the program at once with 128 + the signal's number (130, 143, 129), leaving no
/// half-written file.
void catch_signals();

}  // namespace cli
