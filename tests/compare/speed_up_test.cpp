#include "compare/speed_up.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace keyhole {
namespace {

// Error scale / cost at costs 1, 2, 4.
Converging noise(double scale, std::vector<double> runs = {}) {
    return {{{1, scale}, {2, scale / 2}, {4, scale / 4}}, std::move(runs)};
}

TEST(CostAt, FollowsTheLineThroughThePoints) {
    const std::vector<ConvergencePoint> curve = {{1, 1}, {2, 0.5}, {4, 0.4}};
    EXPECT_DOUBLE_EQ(cost_at(curve, 1), 1);
    EXPECT_DOUBLE_EQ(cost_at(curve, 0.5), 2);
    EXPECT_NEAR(cost_at(curve, std::sqrt(0.5)), std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(cost_at(curve, std::sqrt(0.2)), std::sqrt(8.0), 1e-12);
}

TEST(CostAt, GoesOnInProportionToOneOverTheError) {
    const std::vector<ConvergencePoint> curve = {{1, 1}, {2, 0.5}, {4, 0.4}};
    EXPECT_DOUBLE_EQ(cost_at(curve, 2), 0.5);
    EXPECT_DOUBLE_EQ(cost_at(curve, 0.2), 8);
}

TEST(SpeedUp, IsTheRatioOfErrorsWhereAllIsNoise) {
    EXPECT_NEAR(speed_up(noise(3), noise(1)).mean, 3, 1e-12);
    EXPECT_NEAR(speed_up(noise(1), noise(3)).mean, 1.0 / 3, 1e-12);
    EXPECT_FALSE(speed_up(noise(3), noise(1)).interval);
}

// Bias that stays: the first never gets below 0.9, which the other reaches at cost 1 / 0.9.
TEST(SpeedUp, ComparesAtTheErrorThatBothReach) {
    const Converging stuck = {{{1, 1}, {2, 0.95}, {4, 0.9}}, {}};
    EXPECT_NEAR(speed_up(stuck, noise(1)).mean, 4 * 0.9, 1e-12);
}

// Errors of five runs each, log-normal with deviations 0.2 and 0.4 of the logarithm: 2,000 ratios, of which 100 +- 50
// may be missed by a 95% interval (standard deviation 10; the means of errors are not quite log-normal).
TEST(SpeedUp, IntervalsHoldTheTruthAtTheirLevel) {
    std::mt19937 random(3);
    const auto method = [&](double scale, double deviation) {
        std::lognormal_distribution<double> error(std::log(scale) - deviation * deviation / 2, deviation);
        std::vector<double> runs(5);
        double mean = 0;
        for (double& r : runs) mean += (r = error(random)) / 5;
        Converging c = noise(mean * 4);
        c.relmse_of_runs = runs;
        return c;
    };
    int missed = 0;
    for (int i = 0; i < 2000; ++i) {
        const Interval interval = *speed_up(method(3, 0.2), method(1, 0.4)).interval;
        missed += interval.low > 3 || interval.high < 3;
    }
    EXPECT_NEAR(missed, 100, 50);
}

}  // namespace
}  // namespace keyhole
