#include "base/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "statistics.h"

namespace keyhole {
namespace {

// Three p-values here; together they raise a false alarm with probability 1e-3.
const double level = sidak_level(1e-3, 3);

TEST(Rng, IsPhilox4x32With10Rounds) {
    // First known answer of Random123's kat_vectors: counter and key zero.
    Rng rng(0, 0);
    EXPECT_EQ(rng.bits(), 0x6627e8d5u);
    EXPECT_EQ(rng.bits(), 0xe169c58du);
    EXPECT_EQ(rng.bits(), 0xbc57ac4cu);
    EXPECT_EQ(rng.bits(), 0x9b00dbd8u);
}

TEST(Rng, GoesOnFromASavedState) {
    for (int position = 0; position < 10; ++position) {
        Rng rng(3, 5);
        for (int i = 0; i < position; ++i) rng.bits();
        Rng restored(rng.state());
        EXPECT_EQ(restored.state(), rng.state());
        for (int i = 0; i < 9; ++i) ASSERT_EQ(restored.bits(), rng.bits()) << position;
        EXPECT_EQ(restored.state(), rng.state());
    }
}

TEST(Rng, StreamsShareNoBlock) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    constexpr int streams = 64, blocks = 64;
    for (int seed = 0; seed < 2; ++seed)
        for (int stream = 0; stream < streams; ++stream) {
            Rng rng(seed, stream);
            for (int i = 0; i < blocks; ++i) {
                const std::uint32_t first = rng.bits();
                seen.insert({first, rng.bits()});
                rng.bits();
                rng.bits();
            }
        }
    EXPECT_EQ(seen.size(), 2u * streams * blocks);  // a chance collision has probability 2e-12
}

TEST(Rng, UniformFillsTheUnitInterval) {
    constexpr int n = 200000, cells = 256;
    std::vector<double> observed(cells), expected(cells, double(n) / cells);
    Rng rng(7);
    for (int i = 0; i < n; ++i) {
        const double u = rng.uniform();
        ASSERT_TRUE(u >= 0 && u < 1);
        ++observed[static_cast<std::size_t>(u * cells)];
    }
    EXPECT_GT(chi_square_p_value(expected, observed), level);
}

// Pairs of numbers: successive ones of a stream, and the same position of neighbouring streams.
TEST(Rng, PairsFillTheUnitSquare) {
    constexpr int n = 100000, side = 16;
    for (const bool neighbours : {false, true}) {
        std::vector<double> observed(side * side), expected(side * side, double(n) / (side * side));
        Rng rng(8, 0);
        for (int i = 0; i < n; ++i) {
            Rng left(9, static_cast<std::uint64_t>(i)), right(9, static_cast<std::uint64_t>(i) + 1);
            const double a = neighbours ? left.uniform() : rng.uniform();
            const double b = neighbours ? right.uniform() : rng.uniform();
            ++observed[static_cast<std::size_t>(a * side) * side + static_cast<std::size_t>(b * side)];
        }
        EXPECT_GT(chi_square_p_value(expected, observed), level) << neighbours;
    }
}

TEST(Rng, BelowStaysBelow) {
    Rng rng(10);
    std::set<std::uint32_t> seen;
    for (int i = 0; i < 1000; ++i) seen.insert(rng.below(7));
    EXPECT_EQ(seen.size(), 7u);
    EXPECT_EQ(*seen.rbegin(), 6u);
    EXPECT_EQ(rng.below(1), 0u);
}

}  // namespace
}  // namespace keyhole
