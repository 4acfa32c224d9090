#include "console.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numeric>

#include "gaussmap/io.h"

namespace cli {
namespace {

constexpr char clear_line[] = "\r\x1b[K";

volatile sig_atomic_t bar_on_screen = 0;  // the signal handler looks at it

extern "C" void on_signal(int signal_number) {
    gaussmap::remove_unfinished();
    if (bar_on_screen) {
        [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, clear_line, sizeof clear_line - 1);
    }
    ::_exit(128 + signal_number);
}

/// Edits (insert, remove, replace, swap of neighbours) that turn a into b.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = last;
        last = row;
    }
    return last.back();
}

}  // namespace

bool may_draw() {
    static const bool allowed = [] {
        const char* no_color = std::getenv("NO_COLOR");
        const char* term = std::getenv("TERM");
        return ::isatty(STDERR_FILENO) && !(no_color && *no_color) && !(term && std::strcmp(term, "dumb") == 0);
    }();
    return allowed;
}

std::string bold(std::string_view text) {
    return may_draw() ? fmt::format("\x1b[1m{}\x1b[0m", text) : std::string(text);
}

void say(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
}

void put(std::string_view text) {
    errno = 0;
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
    throw Failure(Exit::failed, fmt::format("standard output: {}", std::strerror(errno)));
}

void complain(std::string_view line) {
    std::string text = fmt::format("gaussmap: {}", line);
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    say(text + "\n");
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& words) {
    std::size_t best = std::numeric_limits<std::size_t>::max();
    const std::string* closest = nullptr;
    for (const std::string& candidate : words) {
        // A beginning of a word ("norm") stands for it as well as a slip of the fingers does.
        const bool begins = word.size() >= 3 && std::string_view(candidate).substr(0, word.size()) == word;
        const std::size_t distance = begins ? 1 : edit_distance(word, candidate);
        if (distance < best) best = distance, closest = &candidate;
    }
    const std::size_t close = std::max<std::size_t>(1, word.size() / 3);
    return closest && best <= close && best < closest->size() ? fmt::format("; did you mean '{}'?", *closest) : "";
}

Progress::Progress(std::string what, bool quiet) : what_(std::move(what)), shown_(!quiet && may_draw()) {}

Progress::~Progress() {
    if (!bar_on_screen) return;
    say(clear_line);
    bar_on_screen = 0;
}

gaussmap::Execution Progress::run(int threads) {
    if (!shown_) return {threads, nullptr};
    return {threads, [this](double fraction) {
                draw(fraction);
                return true;
            }};
}

void Progress::draw(double fraction) {
    using namespace std::chrono_literals;
    const Clock::time_point now = Clock::now();
    if (now - begin_ < 1s || now - drawn_ < 100ms) return;
    drawn_ = now;
    bar_on_screen = 1;
    constexpr int width = 40;
    const int filled = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
    say(fmt::format("\r{} [{:#>{}}{:->{}}] {:3.0f} %", what_, "", filled, "", width - filled, 100 * fraction));
}

void catch_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGHUP, &action, nullptr);
    // A reader that closes the pipe early, or a file beyond the limit, is a failed write told as one, no death by
    // signal.
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, nullptr);
    sigaction(SIGXFSZ, &action, nullptr);
}

}  // namespace cli
