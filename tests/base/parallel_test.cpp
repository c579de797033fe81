// Loops on all threads.
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace keyhole {
namespace {

TEST(ParallelFor, CallsEveryJobOnce) {
    std::vector<int> calls(10000);
    for (int pass = 1; pass <= 3; ++pass) {
        parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; });
        EXPECT_EQ(std::accumulate(calls.begin(), calls.end(), 0), 10000 * pass);
    }
    EXPECT_EQ(calls, std::vector<int>(10000, 3));
    parallel_for(0, [&](std::size_t) { ADD_FAILURE() << "no job"; });
}

TEST(ParallelFor, Nests) {
    std::atomic<int> calls = 0;
    parallel_for(10, [&](std::size_t) { parallel_for(10, [&](std::size_t) { ++calls; }); });
    EXPECT_EQ(calls, 100);
}

TEST(ParallelFor, PassesExceptionsOn) {
    EXPECT_THROW(parallel_for(100,
                              [](std::size_t i) {
                                  if (i == 50) throw std::invalid_argument("job 50");
                              }),
                 std::invalid_argument);
}

}  // namespace
}  // namespace keyhole
