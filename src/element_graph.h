// Averages over the surface: fields on elements and their nearest neighbours.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
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

/// The values of up to 4 · Registers fields at an element.
template <std::size_t Registers>
struct FieldValues {
    typedef float Floats __attribute__((vector_size(16)));
    typedef std::int32_t Flags __attribute__((vector_size(16)));
    Floats part[Registers] = {};

    static Flags finite(Floats value) { return value - value == Floats{}; }
};

/// Means of elements and their neighbours, for the elements [first, last); true where all of them are finite.
/// \tparam Finite  whether all values are: then nothing has to be left out.
template <bool Finite, std::size_t Registers>
bool average_neighbors(const std::vector<FieldValues<Registers>>& values, const ElementGraph& graph, std::size_t first,
                       std::size_t last, std::vector<FieldValues<Registers>>& next) {
    using Values = FieldValues<Registers>;
    using Floats = typename Values::Floats;
    using Flags = typename Values::Flags;
    Flags all_finite = ~Flags{};
    for (std::size_t i = first; i < last; ++i) {
        Values sum;
        Flags terms[Registers] = {};
        const auto take = [&](const Values& value) {
            for (std::size_t r = 0; r < Registers; ++r) {
                const Flags there = Finite ? ~Flags{} : Values::finite(value.part[r]);
                sum.part[r] += (Floats)((Flags)value.part[r] & there);
                terms[r] -= there;
            }
        };
        take(values[i]);
        for (std::size_t j = 0; j < ElementGraph::degree && graph[i][j] >= 0; ++j)
            take(values[static_cast<std::size_t>(graph[i][j])]);
        for (std::size_t r = 0; r < Registers; ++r) {
            next[i].part[r] = sum.part[r] / __builtin_convertvector(terms[r], Floats);  // NaN where there are none
            all_finite &= Values::finite(next[i].part[r]);
        }
    }
    return (all_finite[0] & all_finite[1] & all_finite[2] & all_finite[3]) != 0;
}

template <std::size_t Registers>
void diffuse_together(std::vector<float>* const* fields, std::size_t count, const ElementGraph& graph, int times,
                      const Execution& run) {
    constexpr std::size_t grain = 1024;
    const std::size_t elements = graph.count();
    std::vector<FieldValues<Registers>> values(elements), next(elements);
    for (std::size_t f = 0; f < count; ++f)
        for (std::size_t i = 0; i < elements; ++i) values[i].part[f / 4][f % 4] = (*fields[f])[i];
    std::vector<std::uint8_t> finite(block_count(elements, grain));
    bool all_finite = false;
    for (int t = 0; t < times; ++t) {
        for_blocks(elements, grain, {run.threads, {}}, [&](std::size_t block, std::size_t first, std::size_t last) {
            finite[block] = all_finite ? average_neighbors<true>(values, graph, first, last, next)
                                       : average_neighbors<false>(values, graph, first, last, next);
        });
        all_finite = std::find(finite.begin(), finite.end(), 0) == finite.end();
        std::swap(values, next);
    }
    for (std::size_t f = 0; f < count; ++f)
        for (std::size_t i = 0; i < elements; ++i) (*fields[f])[i] = values[i].part[f / 4][f % 4];
}

/// Replace each field `times` times by its mean over each element and its neighbours; values that are not finite are
/// left out. After t times a value has come from about √t edges away. Up to eight fields go together, a register lane
/// each, in far less time than one after the other.
inline void diffuse(const std::vector<std::vector<float>*>& fields, const ElementGraph& graph, int times,
                    const Execution& run) {
    constexpr std::size_t most = 8;
    for (std::size_t first = 0; first < fields.size(); first += most) {
        const std::size_t count = std::min(most, fields.size() - first);
        (count > 4 ? diffuse_together<2> : diffuse_together<1>)(fields.data() + first, count, graph, times, run);
    }
}
inline void diffuse(std::vector<float>& field, const ElementGraph& graph, int times, const Execution& run) {
    diffuse({&field}, graph, times, run);
}

/// For each element the squared difference between its value and the mean of its neighbours'.
inline std::vector<float> roughness(const std::vector<float>& field, const ElementGraph& graph, const Execution& run) {
    std::vector<float> mean = field;
    diffuse(mean, graph, 1, run);
    for (std::size_t i = 0; i < field.size(); ++i) mean[i] = (field[i] - mean[i]) * (field[i] - mean[i]);
    return mean;
}

}  // namespace gaussmap
