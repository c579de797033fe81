// Errors and warnings from the disagreement of independent replicates.
#include "chain/replicates.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "chain/largest.h"
#include "chain/running_mean.h"

namespace keyhole {
namespace {

TEST(Deviations, EstimateTheVarianceOfAMeanOfUnequalReplicates) {
    // Replicates of 1 to 16 samples each, uniform in [0, 1): the variance of the mean of all is 1 / (12 n). The
    // estimates have a relative standard deviation of at most sqrt(2 / 4) with replicates of such unequal size, so the
    // mean of 40000 one of 0.0035: five of those are a false alarm of 6e-7.
    Rng random(1);
    RunningMean estimated;
    const double n = 1 + 2 + 4 + 8 + 16;
    for (int run = 0; run < 40000; ++run) {
        std::vector<ReplicatePart> parts;
        for (const double count : {1, 2, 4, 8, 16}) {
            ReplicatePart part{0, count};
            for (int i = 0; i < count; ++i) part.sum += random.uniform();
            parts.push_back(part);
        }
        estimated.add(sum_of_squares(deviations(parts)));
    }
    EXPECT_NEAR(estimated.mean() * 12 * n, 1, 5 * 0.0035);
}

TEST(Deviations, AreNotKnownFromOneReplicate) {
    EXPECT_TRUE(std::isinf(deviations(std::vector<ReplicatePart>{{3, 4}})[0]));
    EXPECT_TRUE(std::isinf(deviations(std::vector<ReplicatePart>{{0, 0}, {3, 4}})[1]));
    EXPECT_EQ(deviations(std::vector<ReplicatePart>{{0, 0}, {0, 0}}), std::vector<double>(2, 0.0));
}

// Chains on bins: with the probability `move`, a step draws a bin from bin_weights, else it stays. The autocorrelation
// of anything is (1 - move)^lag, its time 2 / move - 1.
using Sums = std::vector<std::vector<std::vector<double>>>;
constexpr int replicates = 16, chains = 8;
const std::vector<double> bin_weights = {0.3, 0.2, 0.15, 0.1, 0.1, 0.05, 0.05, 0.05};

std::size_t draw_bin(Rng& random) {
    double u = random.uniform();
    std::size_t bin = 0;
    while (bin + 1 < bin_weights.size() && (u -= bin_weights[bin]) >= 0) ++bin;
    return bin;
}

Sums run_chains(double move, int batches, int length, Rng& random) {
    Sums sums(replicates, std::vector(batches, std::vector<double>(bin_weights.size())));
    for (auto& replicate : sums)
        for (int chain = 0; chain < chains; ++chain) {
            std::size_t bin = draw_bin(random);
            for (auto& batch : replicate)
                for (int i = 0; i < length; ++i) {
                    if (random.uniform() < move) bin = draw_bin(random);
                    batch[bin] += 1;
                }
        }
    return sums;
}

TEST(Disagreement, IsAsExpectedWhereChainsForgetExponentially) {
    // Ratios of mean squares with 15 and at least 48 degrees of freedom have a mean of at most 48 / 46 and a relative
    // standard deviation of 0.45: the mean of 8 correlated bins in 60 runs is known to 0.45 / sqrt(60) = 0.06.
    constexpr int batches = 4, length = 100;
    for (const double move : {1.0, 0.1, 0.02, 0.005}) {
        Rng random(2);
        RunningMean found;
        for (int run = 0; run < 60; ++run)
            for (const double ratio : disagreement(run_chains(move, batches, length, random))) found.add(ratio);
        const double expected = expected_disagreement(2 / move - 1, length, batches);
        EXPECT_NEAR(found.mean() / expected, 1.02, 0.25) << move;
    }
}

TEST(Disagreement, RarelyExceedsSixTimesTheExpected) {
    // The level of the warning's tolerance in render/block_record.cpp: by the F distribution with 15 and 48 degrees of
    // freedom 1e-6 of the bins exceed it, and with correlated batches more do.
    int exceeding = 0;
    Rng random(3);
    constexpr int runs = 300, batches = 4, length = 50;
    for (int run = 0; run < runs; ++run)
        for (const double ratio : disagreement(run_chains(0.05, batches, length, random)))
            exceeding += ratio > 6 * expected_disagreement(2 / 0.05 - 1, length, batches);
    EXPECT_LE(exceeding, 2) << "of " << runs * 8;
}

TEST(Disagreement, IsLargeWhereReplicatesKeepToTheirBins) {
    Rng random(4);
    Sums sums = run_chains(0.1, 4, 100, random);
    for (auto& batch : sums[5]) batch[7] += 300;  // one replicate found something more, and stays
    const std::vector<double> ratios = disagreement(sums);
    EXPECT_GT(ratios[7], 6 * expected_disagreement(2 / 0.1 - 1, 100, 4));
}

TEST(Disagreement, IsNotKnownFromTooLittle) {
    Rng random(5);
    EXPECT_TRUE(disagreement({}).empty());
    EXPECT_TRUE(disagreement(run_chains(0.1, 1, 10, random)).empty());
    EXPECT_TRUE(disagreement({{{1, 2}, {3, 4}}}).empty());
    EXPECT_TRUE(disagreement({{{1, 2}, {3, 4}}, {{0, 0}, {0, 0}}}).empty());
}

TEST(Largest, AreTheSameInAnyOrder) {
    Largest<3> a, b, rest;
    for (const double x : {5.0, 1.0, 9.0, 3.0, 7.0, 9.0}) a.add(x);
    for (const double x : {3.0, 9.0, 1.0}) b.add(x);
    for (const double x : {7.0, 9.0, 5.0}) rest.add(x);
    b += rest;
    EXPECT_EQ(a.values(), (std::array{9.0, 9.0, 7.0}));
    EXPECT_EQ(b.values(), a.values());
    EXPECT_EQ(Largest<2>().values(), (std::array{0.0, 0.0}));
}

}  // namespace
}  // namespace keyhole
