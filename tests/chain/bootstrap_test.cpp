// Resampling of seeds, and the mean of independent samples.
#include "chain/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "base/rng.h"
#include "chain/running_mean.h"

namespace keyhole {
namespace {

std::vector<double> counts_of(const std::vector<std::size_t>& indices, std::size_t size) {
    std::vector<double> counts(size);
    for (const std::size_t i : indices) ++counts[i];
    return counts;
}

TEST(Resample, GivesEveryIndexItsShareUpToOne) {
    Rng random(1, 0);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> weights(1 + random.below(50));
        double total = 0;
        for (double& w : weights) total += w = random.uniform() < 0.3 ? 0 : std::exp(20 * random.uniform());
        if (total == 0) total = weights[0] = 1;
        const std::size_t count = random.below(1000);
        const auto indices = resample(weights, count, random.uniform());
        ASSERT_EQ(indices.size(), count);
        ASSERT_TRUE(std::is_sorted(indices.begin(), indices.end()));
        const auto counts = counts_of(indices, weights.size());
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const double expected = static_cast<double>(count) * weights[i] / total;
            // The margin is for rounding of the cumulative sum, relative to count.
            ASSERT_LT(std::abs(counts[i] - expected), 1 + 1e-12 * static_cast<double>(count));
            ASSERT_TRUE(weights[i] > 0 || counts[i] == 0);
        }
    }
}

TEST(Resample, IsUnbiased) {
    // On a grid of 10000 values of u, the mean count is within 1 / 10000 of its expectation: no false alarms.
    const std::vector<double> weights = {0.3, 0, 2.5, 1e-3, 1, 7};
    constexpr int grid = 10000;
    constexpr std::size_t count = 13;
    std::vector<double> sums(weights.size());
    for (int k = 0; k < grid; ++k)
        for (const std::size_t i : resample(weights, count, (k + 0.5) / grid)) ++sums[i];
    for (std::size_t i = 0; i < weights.size(); ++i)
        EXPECT_NEAR(sums[i] / grid, count * weights[i] / 10.801, 1.001 / grid) << i;
}

TEST(Resample, EndsOnAnIndexOfPositiveWeight) {
    const std::vector<double> weights = {0, 0.1, 0.1, 0.1, 0, 0};
    const double just_below_one = 1 - 0x1p-53;
    for (const std::size_t count : {1u, 3u, 7u, 1000u})
        for (const double u : {0.0, 0.5, just_below_one}) {
            const auto indices = resample(weights, count, u);
            ASSERT_EQ(indices.size(), count);
            EXPECT_GE(indices.front(), 1u);
            EXPECT_LE(indices.back(), 3u);
        }
    EXPECT_TRUE(resample(weights, 0, 0.5).empty());
}

TEST(Resample, RefusesWeightsThatMakeNoDistribution) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {-1.0, nan, inf}) {
        const std::vector<double> weights = {1, bad};
        EXPECT_THROW(resample(weights, 1, 0), std::invalid_argument) << bad;
    }
    EXPECT_THROW(resample({}, 1, 0), std::invalid_argument);
    const std::vector<double> zeros = {0, 0};
    EXPECT_THROW(resample(zeros, 1, 0), std::invalid_argument);
}

TEST(BoundedShares, CutTheLargestToTheShare) {
    EXPECT_EQ(bounded_shares(std::vector<double>{1, 0, 2, 3}, 1), (std::vector<double>{1, 0, 2, 3}));
    EXPECT_EQ(bounded_shares(std::vector<double>{1, 0, 2, 3}, 0.5), (std::vector<double>{1, 0, 2, 3}));
    EXPECT_EQ(bounded_shares(std::vector<double>{1, 0, 2, 9}, 0.5), (std::vector<double>{1, 0, 2, 3}));
    EXPECT_EQ(bounded_shares(std::vector<double>{0, 0}, 0.1), (std::vector<double>{0, 0}));
    // Too few for the share.
    EXPECT_EQ(bounded_shares(std::vector<double>{4, 0, 2, 9}, 0.3), (std::vector<double>{2, 0, 2, 2}));
}

TEST(MovedShare, IsWhatIsElsewhere) {
    const std::vector<double> from = {1, 0, 2, 9}, to = {1, 0, 2, 3};
    // 1/12, 2/12, 9/12 and 1/6, 2/6, 3/6.
    EXPECT_NEAR(moved_share(from, to), 0.25, 1e-15);
    EXPECT_NEAR(moved_share(to, from), 0.25, 1e-15);
    EXPECT_EQ(moved_share(from, from), 0);
    EXPECT_NEAR(moved_share(std::vector<double>{1, 0}, std::vector<double>{0, 5}), 1, 1e-15);
    EXPECT_EQ(moved_share(std::vector<double>{0, 0}, std::vector<double>{0, 0}), 0);
}

TEST(BoundedShares, LeaveTheOthersAsTheyAre) {
    Rng random(4, 0);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> weights(50 + random.below(100));
        for (double& w : weights) w = random.uniform() < 0.2 ? 0 : std::exp(15 * random.uniform());
        const double most = 0.05 + 0.3 * random.uniform();  // enough are above zero
        const std::vector<double> bounded = bounded_shares(weights, most);
        double sum = 0;
        for (const double w : bounded) sum += w;
        const double level = *std::max_element(bounded.begin(), bounded.end());
        for (std::size_t i = 0; i < weights.size(); ++i)
            ASSERT_TRUE(bounded[i] == weights[i] || (bounded[i] == level && level < weights[i]));
        if (level < *std::max_element(weights.begin(), weights.end()))
            ASSERT_NEAR(level / (most * sum), 1, 1e-12);
        else
            ASSERT_LE(level, most * sum * (1 + 1e-12));
    }
}

TEST(RunningMean, HasTheMomentsOfItsSamples) {
    RunningMean mean;
    EXPECT_EQ(mean.count(), 0u);
    EXPECT_EQ(mean.standard_error(), std::numeric_limits<double>::infinity());
    for (const double x : {1.0, 2.0, 4.0, 9.0}) mean.add(x);
    EXPECT_EQ(mean.count(), 4u);
    EXPECT_DOUBLE_EQ(mean.mean(), 4);
    EXPECT_DOUBLE_EQ(mean.variance(), 38.0 / 3);
    EXPECT_DOUBLE_EQ(mean.standard_error(), std::sqrt(38.0 / 12));
}

TEST(RunningMean, KeepsItsDigitsFarFromZero) {
    RunningMean mean;
    for (int i = 0; i < 1000; ++i) mean.add(1e9 + (i % 2));
    EXPECT_NEAR(mean.variance(), 0.25 * 1000 / 999, 1e-6);  // samples have a spacing of 1e-7
}

TEST(RunningMean, MergesToTheSameMoments) {
    Rng random(2, 0);
    RunningMean all, left, right, empty;
    for (int i = 0; i < 1000; ++i) {
        const double x = std::exp(random.uniform() * 10);
        all.add(x);
        (i < 300 ? left : right).add(x);
    }
    left.merge(empty);
    empty.merge(right);
    left.merge(empty);
    EXPECT_EQ(left.count(), all.count());
    EXPECT_NEAR(left.mean() / all.mean(), 1, 1e-13);  // rounding of 1000 additions
    EXPECT_NEAR(left.variance() / all.variance(), 1, 1e-13);
}

}  // namespace
}  // namespace keyhole
