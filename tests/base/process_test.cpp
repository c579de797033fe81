#include "base/process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <vector>

namespace keyhole {
namespace {

TEST(Process, CpuSecondsCountsBusyTimeOnly) {
    const double before = cpu_seconds();
    volatile double sink = 0;
    int rounds = 0;
    while (cpu_seconds() - before < 0.05 && ++rounds < 100000)
        for (int i = 0; i < 10000; ++i) sink = sink + std::sqrt(static_cast<double>(i));
    EXPECT_GE(cpu_seconds() - before, 0.05);
    EXPECT_LT(rounds, 100000);
}

TEST(Process, PeakMemoryGrowsWithWhatIsTouched) {
    const std::uint64_t before = peak_memory_bytes();
    ASSERT_GT(before, 0u);
    constexpr std::size_t size = std::size_t{192} << 20;
    {
        std::vector<char> block(size);
        std::memset(block.data(), 1, block.size());
        EXPECT_EQ(block[size / 2], 1);
    }
    // More than the whole process held before, so the block alone must have raised the peak; a peak never falls.
    EXPECT_GE(peak_memory_bytes(), before + size / 2);
#ifndef KEYHOLE_THREAD_SANITIZER  // its shadow memory is several times what it shadows
    EXPECT_LT(peak_memory_bytes(), before + 4 * size);
#endif
}

TEST(Process, PhysicalMemoryHoldsThisProcess) { EXPECT_GT(physical_memory_bytes(), peak_memory_bytes()); }

}  // namespace
}  // namespace keyhole
