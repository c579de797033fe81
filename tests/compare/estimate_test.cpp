#include "compare/estimate.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

namespace keyhole {
namespace {

// From printed tables of Student's t.
TEST(Estimate, QuantilesOfStudentsT) {
    EXPECT_NEAR(student_quantile(1), 12.706, 1e-3);
    EXPECT_NEAR(student_quantile(9), 2.262, 1e-3);
    EXPECT_NEAR(student_quantile(1e9), 1.960, 1e-3);
}

// Mean 4, sample variance 4, standard error 2 / sqrt(3).
TEST(Estimate, OfThreeValues) {
    const Estimate e = estimate_mean(std::array{2.0, 4.0, 6.0});
    EXPECT_DOUBLE_EQ(e.mean, 4);
    ASSERT_TRUE(e.interval);
    EXPECT_NEAR(e.interval->high - 4, 4.303 * 2 / std::sqrt(3.0), 1e-3);
    EXPECT_DOUBLE_EQ(e.interval->low + e.interval->high, 8);
}

TEST(Estimate, OneValueHasNoInterval) {
    EXPECT_FALSE(estimate_mean(std::array{2.0}).interval);
    EXPECT_FALSE(to_json(estimate_mean(std::array{2.0})).contains("low"));
}

// Left out one at a time, a mean of n values is (sum - x_i) / (n - 1), and its jackknife is the interval of the mean.
TEST(Jackknife, OfAMeanIsThatOfStudentsT) {
    const std::array values = {1.0, 2.0, 4.0, 9.0};
    std::vector<double> without;
    for (const double v : values) without.push_back((16 - v) / 3);
    const Estimate e = jackknife(4, without), expected = estimate_mean(values);
    EXPECT_NEAR(e.mean, expected.mean, 1e-12);
    EXPECT_NEAR(e.interval->low, expected.interval->low, 1e-12);
    EXPECT_NEAR(e.interval->high, expected.interval->high, 1e-12);
}

// 4,000 means of five values each: misses have a standard deviation of 14, so 200 +- 70 goes wrong once in 10^6.
TEST(Estimate, IntervalsHoldTheTruthAtTheirLevel) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal(3, 2);
    int missed = 0;
    for (int i = 0; i < 4000; ++i) {
        std::array<double, 5> values;
        for (double& v : values) v = normal(random);
        const Interval interval = *estimate_mean(values).interval;
        missed += interval.low > 3 || interval.high < 3;
    }
    EXPECT_NEAR(missed, 200, 70);
}

}  // namespace
}  // namespace keyhole
