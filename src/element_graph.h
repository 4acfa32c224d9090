// Averages over the surface: fields on elements and their nearest neighbours.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "parallel.h"

namespace gaussmap {

/// Each element's few nearest others, −1 where there are fewer.
struct ElementGraph {
    static constexpr std::size_t degree = 10;
    std::vector<std::int32_t> index;

    std::size_t count() const { return index.size() / degree; }
    const std::int32_t* operator[](std::size_t i) const { return index.data() + i * degree; }
};

/// Replace the field `times` times by its mean over each element and its neighbours; values that are not finite are
/// left out. After t times a value has come from about √t edges away.
inline void diffuse(std::vector<float>& field, const ElementGraph& graph, int times, const Execution& run) {
    constexpr std::size_t grain = 4096;
    std::vector<float> next(field.size());
    for (int t = 0; t < times; ++t) {
        for_blocks(field.size(), grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t last) {
            for (; i < last; ++i) {
                double sum = 0;
                int terms = 0;
                const auto take = [&](float value) {
                    if (std::isfinite(value)) sum += value, ++terms;
                };
                take(field[i]);
                for (std::size_t j = 0; j < ElementGraph::degree && graph[i][j] >= 0; ++j)
                    take(field[static_cast<std::size_t>(graph[i][j])]);
                next[i] = terms > 0 ? static_cast<float>(sum / terms) : std::numeric_limits<float>::quiet_NaN();
            }
        });
        std::swap(field, next);
    }
}

/// The same of up to four fields together, in less time than one after the other; sums are of single precision.
inline void diffuse(std::initializer_list<std::vector<float>*> fields, const ElementGraph& graph, int times,
                    const Execution& run) {
    constexpr std::size_t grain = 4096;
    typedef float Floats __attribute__((vector_size(16)));
    typedef std::int32_t Flags __attribute__((vector_size(16)));
    const std::size_t count = graph.count();
    std::vector<Floats> values(count), next(count);
    std::size_t lane = 0;
    for (const std::vector<float>* field : fields) {
        for (std::size_t i = 0; i < count; ++i) values[i][lane] = (*field)[i];
        ++lane;
    }
    for (int t = 0; t < times; ++t) {
        for_blocks(count, grain, {run.threads, {}}, [&](std::size_t, std::size_t i, std::size_t last) {
            for (; i < last; ++i) {
                Floats sum = {};
                Flags terms = {};
                const auto take = [&](Floats value) {
                    const Flags finite = value - value == Floats{};
                    sum += (Floats)((Flags)value & finite);
                    terms -= finite;
                };
                take(values[i]);
                for (std::size_t j = 0; j < ElementGraph::degree && graph[i][j] >= 0; ++j)
                    take(values[static_cast<std::size_t>(graph[i][j])]);
                next[i] = sum / __builtin_convertvector(terms, Floats);  // NaN where there are none
            }
        });
        std::swap(values, next);
    }
    lane = 0;
    for (std::vector<float>* field : fields) {
        for (std::size_t i = 0; i < count; ++i) (*field)[i] = values[i][lane];
        ++lane;
    }
}

/// For each element the squared difference between its value and the mean of its neighbours'.
inline std::vector<float> roughness(const std::vector<float>& field, const ElementGraph& graph, const Execution& run) {
    std::vector<float> mean = field;
    diffuse(mean, graph, 1, run);
    for (std::size_t i = 0; i < field.size(); ++i) mean[i] = (field[i] - mean[i]) * (field[i] - mean[i]);
    return mean;
}

}  // namespace gaussmap
