#include "base/rng.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "statistics.h"

namespace keyhole {
namespace {

// Three p-values here; together they raise a false alarm with probability 1e-3.
const double level = sidak_level(1e-3, 3);

TEST(Rng, IsPhilox4x32With10Rounds) {
    const std::uint64_t seed = 0x0123456789abcdef, stream = 0xfedcba9876543210;
    for (const std::uint64_t block : {std::uint64_t{0}, std::uint64_t{0xfffffffc}}) {  // carries into the high word
        Rng rng(Rng::State{seed, stream, block + Rng::buffered / 4, 0});
        for (std::uint64_t b = block; b < block + 20; ++b) {
            const auto expected = r123::Philox4x32()(
                {{static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(b >> 32),
                  static_cast<std::uint32_t>(stream), static_cast<std::uint32_t>(stream >> 32)}},
                {{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}});
            for (int i = 0; i < 4; ++i) ASSERT_EQ(rng.bits(), expected[i]) << b << ' ' << i;
        }
    }
}

TEST(Rng, HandsOutWordsInGroups) {
    Rng one(1, 2), group(1, 2);
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t* words = group.bits(8);
        for (int j = 0; j < 8; ++j) EXPECT_EQ(words[j], one.bits());
    }
    group.bits();
    EXPECT_NE(group.bits(Rng::buffered), nullptr);  // does not fit beside the word: the buffer's rest is left out
    EXPECT_EQ(group.state().used, Rng::buffered);
}

TEST(Rng, GoesOnFromASavedState) {
    for (int position = 0; position < 70; ++position) {
        Rng rng(3, 5);
        for (int i = 0; i < position; ++i) rng.bits();
        Rng restored(rng.state());
        EXPECT_EQ(restored.state(), rng.state());
        for (int i = 0; i < 40; ++i) ASSERT_EQ(restored.bits(), rng.bits()) << position;
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
