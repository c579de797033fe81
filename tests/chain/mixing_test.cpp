// What correlated samples are worth, from jumps and from errors.
#include "chain/mixing.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace keyhole {
namespace {

constexpr std::array<double, 1> unit = {0x1p-30};

// Metropolis-Hastings on x uniform in [0, 1): with the probability `large` an independent proposal, else a step of at
// most `size` that is rejected outside. Returns the bound from the jumps, and the variance of means over runs of
// `steps` steps.
struct Walk {
    StateMoments<1> states;
    JumpSums<1> jumps;
    StateMoments<1> means;
};

Walk walk(double large, double size, int steps, int runs) {
    Walk result;
    Rng random(1);
    for (int run = 0; run < runs; ++run) {
        double x = random.uniform(), sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double y = random.uniform() < large ? random.uniform() : x + size * (2 * random.uniform() - 1);
            const double acceptance = y >= 0 && y < 1 ? 1 : 0;
            result.jumps.add({x}, {y}, acceptance, unit);
            if (acceptance > 0) x = y;
            result.states.add({x});
            sum += x;
        }
        result.means.add({sum / steps});
    }
    return result;
}

TEST(Mixing, OfIndependentSamplesIsTheirNumber) {
    const Walk w = walk(1, 0, 1000, 1000);
    EXPECT_NEAR(w.states.variance(0), 1.0 / 12, 0.001);
    const Mixing bound = mixing_bound(w.states.variance(0), w.jumps.mean_square(0, unit), 1e6);
    EXPECT_NEAR(bound.autocorrelation_time, 1, 0.01);
    EXPECT_NEAR(bound.effective_sample_size, 1e6, 1e4);
    // 1000 runs know the variance of their mean to sqrt(2 / 1000) = 0.045, and this is within four of those.
    const Mixing measured = mixing_from_error(w.states.variance(0), w.means.variance(0), 1000);
    EXPECT_NEAR(measured.autocorrelation_time, 1, 0.18);
}

TEST(Mixing, BoundIsBelowTheTimeAndNearItForOneTimeScale) {
    for (const double large : {0.0, 0.02, 0.3}) {
        const Walk w = walk(large, 0.1, 8000, 400);
        const double bound = mixing_bound(w.states.variance(0), w.jumps.mean_square(0, unit), 1).autocorrelation_time;
        const double time = mixing_from_error(w.states.variance(0), w.means.variance(0), 8000).autocorrelation_time;
        EXPECT_LT(bound, 1.28 * time) << large;  // the measured time has a relative standard error of 0.07
        EXPECT_GT(bound, 0.5 * time) << large;
    }
}

TEST(Mixing, IsNotKnownWithoutMoves) {
    EXPECT_TRUE(std::isinf(mixing_bound(1, 0, 100).autocorrelation_time));
    EXPECT_EQ(mixing_bound(0, 0, 100).effective_sample_size, 0);
    EXPECT_EQ(mixing_from_error(1, std::numeric_limits<double>::infinity(), 100).effective_sample_size, 0);
    EXPECT_EQ(mixing_from_error(0, 0, 100).effective_sample_size, 0);
}

TEST(StateMoments, DoNotTakeRoundingForAVariance) {
    StateMoments<1> moments;
    for (int i = 0; i < 1000; ++i) moments.add({0.1 + 3});
    EXPECT_EQ(moments.variance(0), 0);
}

TEST(JumpSums, CountFailuresAsNoMove) {
    JumpSums<1> a, b;
    a.add({0.5}, {0.75}, 0.5, unit);
    b.add({0.5}, {0.5}, 0, unit);
    a += b;
    EXPECT_EQ(a.proposals, 2u);
    EXPECT_NEAR(a.mean_square(0, unit), 0.5 * 0.0625 / 2, unit[0]);
}

}  // namespace
}  // namespace keyhole
