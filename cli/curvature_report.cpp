#include "curvature_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cli {
namespace {

/// Errors of the densities where both they and the truth are defined.
Json errors(const std::vector<double>& density, const std::vector<double>& truth, const std::string& name) {
    double squares = 0, truth_squares = 0;
    std::size_t compared = 0;
    std::vector<double> relative;
    for (std::size_t i = 0; i < density.size(); ++i) {
        const double error = density[i] - truth[i];
        if (!std::isfinite(error)) continue;
        squares += error * error;
        truth_squares += truth[i] * truth[i];
        ++compared;
        if (truth[i] != 0) relative.push_back(std::abs(error / truth[i]));
    }
    // Of nothing the root mean square is 0/0 = NaN, which JSON shows as null; so is an error relative to zeros.
    const double rmse = std::sqrt(squares / static_cast<double>(compared));
    const double scale = std::sqrt(truth_squares / static_cast<double>(compared));
    return {{"property", name},
            {"rmse", rmse},
            {"relative_rmse", scale > 0 ? Json(rmse / scale) : Json()},
            {"median_relative_error", statistics(relative)["p50"]},
            {"compared", compared}};
}

/// Standard errors relative to the densities, and, where the truth is known, how often it lies within two of them.
Json confidence(const Measured& measured, const std::vector<double>& truth) {
    std::vector<double> relative;
    std::size_t within = 0, compared = 0;
    for (std::size_t i = 0; i < measured.error.size(); ++i) {
        const double density = measured.density[i], error = measured.error[i];
        if (density > 0) relative.push_back(error / density);
        if (truth.empty() || !std::isfinite(density - truth[i]) || !std::isfinite(error)) continue;
        ++compared;
        within += std::abs(density - truth[i]) <= 2 * error;
    }
    Json out = {{"median_relative_error", statistics(relative)["p50"]}};
    if (!truth.empty()) out["truth_within_two_errors"] = static_cast<double>(within) / static_cast<double>(compared);
    return out;
}

/// How many took what, in the order of the choices.
Json chosen(const std::vector<std::uint8_t>& choice) {
    std::array<std::size_t, 256> counts{};
    for (const std::uint8_t c : choice) ++counts[c];
    Json out = Json::object();
    for (std::size_t c = 0; c < counts.size(); ++c)
        if (counts[c] > 0) out[gaussmap::choice_name(static_cast<std::uint8_t>(c))] = counts[c];
    return out;
}

/// The three most frequent, and how many took another.
std::string most_frequent(const Json& counts) {
    std::vector<std::pair<std::size_t, std::string>> sorted;
    for (const auto& [name, n] : counts.items()) sorted.emplace_back(n.get<std::size_t>(), name);
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string out;
    std::size_t others = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (i >= 3)
            others += sorted[i].first;
        else
            out += fmt::format("{}{}: {}", out.empty() ? "" : "; ", sorted[i].second, count(sorted[i].first));
    }
    return others > 0 ? out + "; others: " + count(others) : out;
}

void add_tensor(Table& table, const Json& tensor) {
    for (const char* name : {"k1", "k2"})
        table.add(name,
                  fmt::format("mean {}, rms {}, from {} to {} (1/unit)", number(tensor[name]["mean"]),
                              number(tensor[name]["rms"]), number(tensor[name]["min"]), number(tensor[name]["max"])));
}

void add_confidence(Table& table, const Json& confidence) {
    std::string words = "median standard error " + number(confidence["median_relative_error"]) + " of the density";
    if (const Json* const within = confidence.find("truth_within_two_errors"))
        words += fmt::format(", the truth within two errors for {} of all", number(*within));
    table.add("confidence", words);
}

void add_truth(Table& table, const Json& truth, const char* one, const char* many) {
    table.add("truth", fmt::format("{}: RMSE {}, relative {}, median relative error {}, {} compared",
                                   truth["property"].get<std::string>(), number(truth["rmse"]),
                                   number(truth["relative_rmse"]), number(truth["median_relative_error"]),
                                   count(truth["compared"].get<std::size_t>(), one, many)));
}

}  // namespace

Json curvature_report(const CurvatureOptions& o, const CurvaturePlan& plan, const gaussmap::Geometry& geometry,
                      const Measured& measured, const std::vector<double>& truth, int threads) {
    Json report = {{"kind", plan.mesh ? "mesh" : "cloud"}, {"file", o.input}};
    report["vertices"] = geometry.vertex_count();
    report["faces"] = geometry.face_count();
    report["normals"] = plan.normals;
    report["estimator"] = gaussmap::estimator_name(plan.estimator());
    const bool fans = !plan.mesh && !plan.automatic_cloud();
    report["k"] = plan.takes_k() ? Json(o.k) : Json();
    report["orient"] = fans && !plan.file_normals ? Json(o.orient) : Json();
    report["threads"] = threads;
    if (plan.mesh) report["kappa"] = {{"sum", measured.kappa_sum}};
    report["density"] = statistics(measured.density);
    if (o.tensor) report["tensor"] = {{"k1", statistics(measured.tensor.k1)}, {"k2", statistics(measured.tensor.k2)}};
    if (o.confidence) report["confidence"] = confidence(measured, truth);
    if (plan.estimator() == gaussmap::Estimator::automatic) report["chosen"] = chosen(measured.choice);
    report.update(measured.counts);
    if (!o.truth.empty()) report["truth"] = errors(measured.density, truth, o.truth);
    return report;
}

std::string curvature_title(const Json& report) {
    const std::string vertices = count(report["vertices"].get<std::size_t>(), "vertex", "vertices");
    if (report["kind"].get<std::string>() == "cloud")
        return fmt::format("{}: a cloud of {}", report["file"].get<std::string>(),
                           count(report["vertices"].get<std::size_t>(), "point", "points"));
    return fmt::format("{}: a mesh of {} and {}", report["file"].get<std::string>(), vertices,
                       count(report["faces"].get<std::size_t>(), "face", "faces"));
}

Table curvature_table(const Json& report) {
    const bool mesh = report["kind"].get<std::string>() == "mesh";
    const auto n = [&](const char* key) { return report[key].get<std::size_t>(); };
    const auto where_there = [&](const char* key, auto&& add) {
        if (const Json* const part = report.find(key)) add(*part);
    };
    const char *const one = mesh ? "vertex" : "point", *const many = mesh ? "vertices" : "points";
    Table table;
    table.add("normals", report["normals"].get<std::string>());
    table.add("estimator", report["estimator"].get<std::string>());
    where_there("chosen", [&](const Json& chosen) { table.add("chosen", most_frequent(chosen)); });
    if (!report["k"].is_null()) table.add("neighbours", number(report["k"]));
    const Json& d = report["density"];
    table.add("density", fmt::format("mean {}, rms {}, from {} to {} (1/unit²)", number(d["mean"]), number(d["rms"]),
                                     number(d["min"]), number(d["max"])));
    table.add("percentiles",
              fmt::format("2 %: {}, 50 %: {}, 98 %: {}", number(d["p02"]), number(d["p50"]), number(d["p98"])));
    where_there("confidence", [&](const Json& part) { add_confidence(table, part); });
    where_there("tensor", [&](const Json& part) { add_tensor(table, part); });
    if (mesh) table.add("kappa", "sum " + number(report["kappa"]["sum"]) + " (no unit)");
    table.add("undefined", count(n("undefined"), one, many) +
                               (mesh ? ", " + count(n("undefined_faces"), "face", "faces") : std::string()));
    if (mesh) table.add("degenerate", count(n("degenerate_faces"), "face", "faces") + " of no area");
    table.add("duplicate", count(n("duplicates"), one, many) + " at the position of an earlier one");
    table.add("non-finite", count(n("non_finite"), one, many));
    if (!mesh && !report["boundary"].is_null()) table.add("boundary", count(n("boundary"), one, many));
    if (n("lowered") > 0) table.add("lower degree", count(n("lowered"), one, many));
    where_there("truth", [&](const Json& part) { add_truth(table, part, one, many); });
    add_ending(table, report);
    return table;
}

}  // namespace cli
