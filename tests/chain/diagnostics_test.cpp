// Counts of steps, and what correlated samples are worth.
#include "chain/diagnostics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "base/rng.h"
#include "chain/autocorrelation.h"
#include "chain/batch_means.h"

namespace keyhole {
namespace {

TEST(Diagnostics, CountsAndAddsUpInAnyOrder) {
    Diagnostics a(2), b(2);
    a.strategies[0].add(Failure::none, 0.25, false);
    a.strategies[0].add(Failure::none, 1, true);
    a.strategies[0].add(Failure::occluded, 0, false);
    a.strategies[1].add(Failure::outside_film, 0, false);
    b.strategies[0].add(Failure::none, 1.0 / 3, true);
    b.idle = 7;

    Diagnostics ab = a, ba = b;
    ab += b;
    ba += a;
    EXPECT_EQ(ab, ba);
    EXPECT_EQ(ab.idle, 7u);
    EXPECT_EQ(ab.strategies[0].proposals, 4u);
    EXPECT_EQ(ab.strategies[0].accepted, 2u);
    EXPECT_EQ(ab.strategies[0].failed(Failure::none), 3u);
    EXPECT_EQ(ab.strategies[0].failed(Failure::occluded), 1u);
    EXPECT_EQ(ab.strategies[1].failed(Failure::outside_film), 1u);
    // A sum of four terms, each rounded to a multiple of acceptance_unit.
    EXPECT_NEAR(ab.strategies[0].mean_acceptance(), (0.25 + 1 + 1.0 / 3) / 4, StrategyCounts::acceptance_unit);
    EXPECT_EQ(ab.total().proposals, 5u);
    EXPECT_EQ(ab.total().accepted, 2u);
    EXPECT_EQ(StrategyCounts().mean_acceptance(), 0);
}

TEST(Diagnostics, EveryFailureHasItsOwnName) {
    std::set<std::string_view> names(failure_names.begin(), failure_names.end());
    EXPECT_EQ(names.size(), failure_kinds);
    EXPECT_EQ(names.count(""), 0u);
    EXPECT_EQ(failure_name(Failure::other), "other");
    EXPECT_EQ(failure_name(Failure::inverse_failed), "inverse failed");
}

double draw_normal(Rng& random) {
    return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * std::numbers::pi * random.uniform());
}

// The autoregressive process x' = phi x + noise with variance one: correlation phi^lag, integrated autocorrelation time
// (1 + phi) / (1 - phi). Starts in equilibrium.
template <class Estimator>
void feed_autoregression(double phi, int samples, std::uint64_t stream, Estimator& estimator) {
    Rng random(1, stream);
    double x = draw_normal(random);
    for (int i = 0; i < samples; ++i) {
        estimator.add(3 + x);
        x = phi * x + std::sqrt(1 - phi * phi) * draw_normal(random);
    }
}

TEST(BatchMeans, EstimatesTheErrorOfCorrelatedSamples) {
    // The squared error of the mean of n samples is time / n; its estimate from 64 to 128 batches has a relative
    // standard deviation of at most sqrt(2 / 63) = 0.18, and its mean over 60 runs of 0.023. Five of those are a false
    // alarm of 6e-7. Batches of at least 512 samples take off at most time / 512, for 9 below 2%.
    constexpr int samples = 1 << 16, runs = 60;
    for (const double phi : {0.0, 0.8, -0.5}) {
        const double time = (1 + phi) / (1 - phi);
        RunningMean squared_error;
        for (std::uint64_t run = 0; run < runs; ++run) {
            BatchMeans batches;
            feed_autoregression(phi, samples, run, batches);
            squared_error.add(batches.standard_error() * batches.standard_error());
            ASSERT_EQ(batches.count(), static_cast<std::uint64_t>(samples));
            ASSERT_NEAR(batches.effective_sample_size() * batches.standard_error() * batches.standard_error(),
                        batches.variance(), 1e-12 * batches.variance());
        }
        EXPECT_NEAR(squared_error.mean() * samples / time, 1, 5 * 0.023 + 0.02) << "phi " << phi;
    }
}

TEST(BatchMeans, TheMeanIsWithinItsError) {
    // z^2 of 200 independent runs against the known mean 3 sums to a chi-square variable with about 200 degrees of
    // freedom (the estimated error makes its tails a little heavier): 200 +- 5 standard deviations of 20.
    double sum = 0;
    for (std::uint64_t run = 0; run < 200; ++run) {
        BatchMeans batches;
        feed_autoregression(0.8, 1 << 14, 1000 + run, batches);
        const double z = (batches.mean() - 3) / batches.standard_error();
        sum += z * z;
    }
    EXPECT_NEAR(sum, 200, 100);
}

TEST(BatchMeans, KnowsLittleOfFewSamples) {
    BatchMeans batches;
    EXPECT_EQ(batches.effective_sample_size(), 0);
    batches.add(1);
    EXPECT_EQ(batches.effective_sample_size(), 0);
    EXPECT_EQ(batches.standard_error(), std::numeric_limits<double>::infinity());
    for (int i = 0; i < 999; ++i) batches.add(1);
    EXPECT_EQ(batches.effective_sample_size(), 1000);  // constant: nothing is uncertain
    EXPECT_EQ(batches.standard_error(), 0);
    EXPECT_EQ(batches.batch_length(), 8u);  // 128 batches of 8 would be 1024
}

TEST(Autocorrelation, OfAnAutoregressiveProcess) {
    // The standard error of a correlation is below sqrt((1 + phi^2) / (1 - phi^2) / n) [Bartlett 1946], 0.0042 for 0.9
    // and n = 2^19; that of the integrated time about time * sqrt(4 * window / n) = 0.23 (5 times the time summed up).
    // Five standard errors, 6e-7 for each comparison.
    constexpr int samples = 1 << 19;
    for (const double phi : {0.9, 0.0, -0.5}) {
        Autocorrelation correlation(200);
        feed_autoregression(phi, samples, 5000, correlation);
        for (const std::size_t lag : {0u, 1u, 2u, 10u, 50u})
            EXPECT_NEAR(correlation.at(lag), std::pow(phi, lag), 5 * 0.0042) << phi << " at " << lag;
        const double time = (1 + phi) / (1 - phi);
        const double window = 5 * std::max(1.0, time);  // where the sum is to end
        double expected = 1;
        for (int lag = 1; lag < window; ++lag) expected += 2 * std::pow(phi, lag);
        EXPECT_NEAR(correlation.integrated_time(), expected, 5 * time * std::sqrt(4 * window / samples)) << phi;
    }
}

TEST(Autocorrelation, IsThatOfTheDefinition) {
    // Against the plain double sum, on a short series far from zero that wraps around the ring buffer.
    constexpr std::size_t max_lag = 7, n = 100;
    Rng random(2, 0);
    std::vector<double> x;
    Autocorrelation correlation(max_lag);
    for (std::size_t i = 0; i < n; ++i) {
        x.push_back(1e6 + random.uniform() + static_cast<double>(i % 3));
        correlation.add(x.back());
    }
    double mean = 0, variance = 0;
    for (const double v : x) mean += v / n;
    for (const double v : x) variance += (v - mean) * (v - mean) / n;
    for (std::size_t lag = 0; lag <= max_lag; ++lag) {
        double sum = 0;
        for (std::size_t i = lag; i < n; ++i) sum += (x[i] - x[0]) * (x[i - lag] - x[0]);
        const double expected = (sum / static_cast<double>(n - lag) - (mean - x[0]) * (mean - x[0])) / variance;
        EXPECT_NEAR(correlation.at(lag), expected, 1e-8) << lag;  // values have a spacing of 1e-10
    }
    EXPECT_EQ(correlation.at(0), 1);
}

TEST(Autocorrelation, OfNothingIsZero) {
    Autocorrelation correlation(3);
    EXPECT_EQ(correlation.at(0), 0);
    for (int i = 0; i < 3; ++i) correlation.add(5);
    EXPECT_EQ(correlation.at(1), 0);
    EXPECT_EQ(correlation.at(3), 0);
}

}  // namespace
}  // namespace keyhole
