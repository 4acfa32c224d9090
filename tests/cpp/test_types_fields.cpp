// Averages over the surface: fields that go together are as those that go alone, by the plain formula, whatever is not
// finite, for any number of threads. And what threads borrow from each other.
#include <cmath>
#include <limits>
#include <vector>

#include "../../src/element_graph.h"
#include "../../src/pool.h"
#include "support.h"

using namespace gaussmap;
using support::Random;

namespace {

constexpr float no_number = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();

ElementGraph random_graph(std::size_t count, Random& random) {
    ElementGraph graph;
    graph.index.assign(count * ElementGraph::degree, -1);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0, degree = random.below(ElementGraph::degree + 1); j < degree; ++j)
            graph.index[i * ElementGraph::degree + j] = static_cast<std::int32_t>(random.below(count));
    return graph;
}

std::vector<float> by_the_formula(std::vector<float> field, const ElementGraph& graph, int times) {
    for (; times > 0; --times) {
        const std::vector<float> before = field;
        for (std::size_t i = 0; i < field.size(); ++i) {
            double sum = 0;
            int terms = 0;
            const auto take = [&](float value) {
                if (std::isfinite(value)) sum += static_cast<double>(value), ++terms;
            };
            take(before[i]);
            for (std::size_t j = 0; j < ElementGraph::degree && graph[i][j] >= 0; ++j)
                take(before[static_cast<std::size_t>(graph[i][j])]);
            field[i] = terms > 0 ? static_cast<float>(sum / terms) : no_number;
        }
    }
    return field;
}

}  // namespace

TEST(Fields, AreAveragedTogetherAsAloneForAnyThreads) {
    constexpr std::size_t count = 3000;
    Random random(1);
    const ElementGraph graph = random_graph(count, random);
    std::vector<std::vector<float>> fields(
        11, std::vector<float>(count));  // of which the last three have a turn of their own
    for (std::size_t f = 0; f < fields.size(); ++f)
        for (float& value : fields[f]) {
            value = static_cast<float>(random.uniform());
            if (f % 3 == 1 && random.below(3) > 0) value = random.below(2) == 0 ? no_number : infinity;
        }
    for (const int times : {0, 1, 7}) {
        std::vector<std::vector<float>> together = fields, threaded = fields;
        std::vector<std::vector<float>*> all, of_threads;
        for (std::vector<float>& field : together) all.push_back(&field);
        for (std::vector<float>& field : threaded) of_threads.push_back(&field);
        diffuse(all, graph, times, {1, {}});
        diffuse(of_threads, graph, times, {7, {}});
        for (std::size_t f = 0; f < fields.size(); ++f) {
            std::vector<float> alone = fields[f];
            diffuse(alone, graph, times, {1, {}});
            const std::vector<float> truth = by_the_formula(fields[f], graph, times);
            for (std::size_t i = 0; i < count; ++i) {
                if (times > 0 && std::isnan(truth[i])) {
                    ASSERT_TRUE(std::isnan(together[f][i]) && std::isnan(alone[i]) && std::isnan(threaded[f][i]));
                } else if (std::isfinite(truth[i])) {
                    ASSERT_NEAR(together[f][i], truth[i], 1e-6);
                    ASSERT_EQ(together[f][i], alone[i]);
                    ASSERT_EQ(together[f][i], threaded[f][i]);
                }
            }
        }
    }
}

/// Sums of finite values may overflow; what comes of it is left out from then on.
TEST(Fields, LeaveOutWhatOverflows) {
    ElementGraph graph;
    graph.index.assign(3 * ElementGraph::degree, -1);
    graph.index[0] = 1;                         // 0 sees 1
    graph.index[2 * ElementGraph::degree] = 0;  // 2 sees 0
    constexpr float huge = std::numeric_limits<float>::max();
    std::vector<float> field = {huge, huge, 1};
    diffuse(field, graph, 1, {1, {}});
    EXPECT_TRUE(std::isinf(field[0]));
    field[2] = 1;
    diffuse(field, graph, 1, {1, {}});
    EXPECT_EQ(field[2], 1);
}

TEST(Pool, LendsAgainWhatWasGivenBack) {
    Pool<std::vector<int>> pool;
    auto one = pool.take(), other = pool.take();
    EXPECT_NE(one.get(), other.get());
    one->push_back(3);
    const std::vector<int>* was = one.get();
    pool.give_back(std::move(one));
    EXPECT_EQ(pool.take().get(), was);
    EXPECT_TRUE(other->empty());
}
