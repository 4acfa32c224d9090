// What a run found, as one JSON object; the text for people is made from the same object.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "commandline.h"
#include "json.h"

namespace cli {

/// Wall-clock seconds since it was made, or since the last lap.
class Stopwatch {
  public:
    double total() const;
    double lap();

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin_ = Clock::now(), lap_ = begin_;
};

/// min, mean, rms, max and the 2nd, 50th and 98th percentile (linear between ranks) of the finite values; all null
/// where there are none.
Json statistics(const std::vector<double>& values);

/// The most memory the process held so far, in bytes.
std::size_t peak_bytes();

/// "12,345"
std::string count(std::size_t n);
/// "1 vertex", "12,345 vertices"
std::string count(std::size_t n, const char* one, const char* many);
/// A number of a report: six digits, "none" for null.
std::string number(const Json& value);
/// "3.4 MB"
std::string bytes(std::size_t n);
/// "'a', 'b' and 'c'"
std::string listed(const std::vector<std::string>& names);

/// Aligned lines "  label   words".
class Table {
  public:
    void add(const std::string& label, const std::string& words) { rows_.emplace_back(label, words); }
    std::string text() const;

  private:
    std::vector<std::pair<std::string, std::string>> rows_;
};

/// The rows that end a report on a file: time and memory, and what was written.
void add_ending(Table& table, const Json& report);

/// The last of every verb: the JSON on standard output, or the text on standard error, with the notes of the report.
void present(const Json& report, const std::string& title, const Table& table, const Common& common);

}  // namespace cli
