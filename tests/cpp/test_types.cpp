// Views, widening, and how calls run: blocks, threads, exceptions, progress, cancelling.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <vector>

#include "../../src/parallel.h"
#include "gaussmap/types.h"

namespace {

using namespace gaussmap;

TEST(Points, ViewAVectorWithoutCopyingIt) {
    const std::vector<double> flat{1, 2, 3, 4, 5, 6};
    const Points points = flat;
    EXPECT_EQ(points.count, 2u);
    EXPECT_EQ(points.xyz, flat.data());
    EXPECT_EQ(points[1][0], 4);
    EXPECT_FALSE(points.empty());
    EXPECT_TRUE(Points().empty());
    static_assert(!std::is_constructible_v<Points, std::vector<double>&&>, "a view of a temporary would dangle");
}

TEST(Triangles, ViewAVectorWithoutCopyingIt) {
    const std::vector<std::int32_t> flat{0, 1, 2, 2, 1, 3};
    const Triangles faces = flat;
    EXPECT_EQ(faces.count, 2u);
    EXPECT_EQ(faces.abc, flat.data());
    EXPECT_EQ(faces[1][2], 3);
    EXPECT_FALSE(faces.empty());
    EXPECT_TRUE(Triangles().empty());
    static_assert(!std::is_constructible_v<Triangles, std::vector<std::int32_t>&&>,
                  "a view of a temporary would dangle");
}

TEST(Widen, IsExact) {
    const float values[] = {0.1f, -0.0f, 1e-45f, 3.4e38f, std::numeric_limits<float>::quiet_NaN()};
    const std::vector<double> wide = widen(values, 5);
    ASSERT_EQ(wide.size(), 5u);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(static_cast<float>(wide[i]), values[i]);
    EXPECT_TRUE(std::signbit(wide[1]));
    EXPECT_TRUE(std::isnan(wide[4]));
    EXPECT_TRUE(widen(nullptr, 0).empty());
}

TEST(ThreadCount, IsWhatWasAskedFor) {
    EXPECT_EQ(thread_count({5, {}}), 5);
    EXPECT_GE(thread_count({}), 1);
}

class ForBlocks : public testing::TestWithParam<int> {
  protected:
    Execution run() const { return {GetParam(), {}}; }
};
INSTANTIATE_TEST_SUITE_P(Threads, ForBlocks, testing::Values(1, 2, 7));

TEST_P(ForBlocks, VisitEveryItemOnceInTheSameBlocks) {
    std::vector<int> visits(1003), block_of(1003);
    for_blocks(1003, 10, run(), [&](std::size_t block, std::size_t begin, std::size_t end) {
        EXPECT_EQ(begin, 10 * block);
        EXPECT_EQ(end, std::min<std::size_t>(1003, begin + 10));
        for (std::size_t i = begin; i < end; ++i) ++visits[i], block_of[i] = static_cast<int>(block);
    });
    for (int i = 0; i < 1003; ++i) {
        EXPECT_EQ(visits[i], 1);
        EXPECT_EQ(block_of[i], i / 10);
    }
}

TEST_P(ForBlocks, OfNothingDoNothing) {
    for_blocks(0, 10, run(), [](std::size_t, std::size_t, std::size_t) { FAIL() << "no block to run"; });
}

TEST_P(ForBlocks, RethrowWhatABodyThrowsAndSkipTheRest) {
    std::atomic<int> bodies{0};
    try {
        for_blocks(100000, 1, run(), [&](std::size_t block, std::size_t, std::size_t) {
            ++bodies;
            if (block == 3) throw std::out_of_range("block three");
            // Else all others could be done while the thread of this one waits for a processor.
            if (block > 3) std::this_thread::sleep_for(std::chrono::microseconds(50));
        });
        FAIL() << "no exception";
    } catch (const std::out_of_range& error) { EXPECT_STREQ(error.what(), "block three"); }
    EXPECT_LT(bodies, 100000);
}

TEST_P(ForBlocks, ReportProgressFromTheCallersThread) {
    double last = 0;
    int calls = 0;
    const auto caller = std::this_thread::get_id();
    Execution reporting = run();
    reporting.progress = [&](double fraction) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_GT(fraction, last);
        EXPECT_LE(fraction, 1);
        last = fraction;
        ++calls;
        return true;
    };
    for_blocks(64, 1, reporting, [](std::size_t, std::size_t, std::size_t) {});
    EXPECT_EQ(last, 1);
    EXPECT_TRUE(GetParam() > 1 || calls == 64) << calls;
}

TEST_P(ForBlocks, ThrowCancelledWhenProgressSaysNo) {
    std::atomic<int> bodies{0};
    Execution cancelling = run();
    cancelling.progress = [](double) { return false; };
    // With several threads the caller's own thread must get a block to be asked. So the others are slow: on a busy
    // machine they would be through with a million before it has its turn.
    const auto count = [&bodies, caller = std::this_thread::get_id()](std::size_t, std::size_t, std::size_t) {
        ++bodies;
        if (std::this_thread::get_id() != caller) std::this_thread::sleep_for(std::chrono::microseconds(10));
    };
    EXPECT_THROW(for_blocks(1000000, 1, cancelling, count), Cancelled);
    EXPECT_LT(bodies, 1000000);
}

TEST(Cancelled, IsARuntimeErrorThatSaysSo) {
    EXPECT_STREQ(Cancelled().what(), "cancelled");
    static_assert(std::is_base_of_v<std::runtime_error, Cancelled>);
}

TEST(PartOf, ScalesProgressAndPassesTheAnswerOn) {
    std::vector<double> seen;
    const Execution whole{3, [&](double fraction) { return seen.push_back(fraction), fraction < 0.7; }};
    const Execution part = part_of(whole, 0.5, 0.75);
    EXPECT_EQ(part.threads, 3);
    EXPECT_TRUE(part.progress(0));
    EXPECT_TRUE(part.progress(0.5));
    EXPECT_FALSE(part.progress(1));
    EXPECT_EQ(seen, (std::vector<double>{0.5, 0.625, 0.75}));
    EXPECT_FALSE(part_of(Execution{2, {}}, 0, 1).progress);
}

}  // namespace
