#include "report.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "console.h"

namespace cli {
namespace {

/// Linear between ranks, of values at least one of which there must be.
double percentile(std::vector<double>& values, double fraction) {
    const double rank = fraction * static_cast<double>(values.size() - 1);
    const auto below = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), below, values.end());
    const double low = *below, weight = rank - std::floor(rank);
    if (weight == 0) return low;
    return low + weight * (*std::min_element(below + 1, values.end()) - low);
}

}  // namespace

double Stopwatch::total() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
}

double Stopwatch::lap() {
    const Clock::time_point now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(lap_, now)).count();
}

Json statistics(const std::vector<double>& values) {
    Json out = {{"min", nullptr}, {"mean", nullptr}, {"rms", nullptr}, {"max", nullptr},
                {"p02", nullptr}, {"p50", nullptr},  {"p98", nullptr}};
    std::vector<double> defined;
    defined.reserve(values.size());
    std::copy_if(values.begin(), values.end(), std::back_inserter(defined), [](double v) { return std::isfinite(v); });
    if (defined.empty()) return out;
    double sum = 0, squares = 0;
    for (const double v : defined) sum += v, squares += v * v;
    const auto [least, most] = std::minmax_element(defined.begin(), defined.end());
    const double n = static_cast<double>(defined.size());
    out["min"] = *least;
    out["mean"] = sum / n;
    out["rms"] = std::sqrt(squares / n);
    out["max"] = *most;
    out["p02"] = percentile(defined, 0.02);
    out["p50"] = percentile(defined, 0.50);
    out["p98"] = percentile(defined, 0.98);
    return out;
}

std::size_t peak_bytes() {
    // Linux counts the peak of the program that started this one into ru_maxrss; VmHWM is of this one alone.
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return 1024 * std::stoull(line.substr(6));
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024 * static_cast<std::size_t>(usage.ru_maxrss);
}

std::string count(std::size_t n) {
    std::string digits = std::to_string(n);
    for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, 1, ',');
    return digits;
}

std::string count(std::size_t n, const char* one, const char* many) {
    return count(n) + " " + (n == 1 ? one : many);
}

std::string number(const Json& value) {
    return value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : "none";
}

std::string bytes(std::size_t n) {
    const char* const units[] = {"B", "kB", "MB", "GB", "TB"};
    double value = static_cast<double>(n);
    std::size_t unit = 0;
    while (value >= 1000 && unit + 1 < std::size(units)) value /= 1000, ++unit;
    return fmt::format("{:.3g} {}", value, units[unit]);
}

std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i)
        out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + fmt::format("'{}'", names[i]);
    return out;
}

std::string Table::text() const {
    std::size_t width = 0;
    for (const auto& [label, words] : rows_) width = std::max(width, label.size());
    std::string out;
    for (const auto& [label, words] : rows_)
        out += fmt::format("  {:<{}}  {}\n", label, width, wrapped(words, width + 4));
    return out;
}

void add_ending(Table& table, const Json& report) {
    table.add("time", fmt::format("{:.3g} s, peak memory {}", report["seconds"]["total"].get<double>(),
                                  bytes(report["peak_bytes"].get<std::size_t>())));
    for (const Json& path : report["outputs"]) table.add("wrote", path.get<std::string>());
}

void present(const Json& report, const std::string& title, const Table& table, const Common& common) {
    if (common.json) {
        put(report.dump() + "\n");
        return;
    }
    if (common.quiet) return;
    say(bold(title) + "\n" + table.text());
    for (const Json& note : report["notes"]) say(wrapped("note: " + note.get<std::string>(), 6) + "\n");
}

}  // namespace cli
