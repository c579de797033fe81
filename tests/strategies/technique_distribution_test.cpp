#include "strategies/technique_distribution.h"

#include <gtest/gtest.h>

#include <numeric>

#include "base/rng.h"
#include "statistics.h"

namespace keyhole {
namespace {

constexpr double family_level = 1e-4;  // of the three chi-square tests below

std::vector<double> some_energies(std::size_t n) {
    std::vector<double> energies(n);
    for (std::size_t i = 0; i < n; ++i) energies[i] = static_cast<double>((i * 7) % 5);
    return energies;
}

TEST(TechniqueDistribution, HasOneTechniqueForLengthOneAndAllForOthers) {
    const TechniqueDistribution d(1, 4);
    EXPECT_EQ(d.techniques().size(), 1u + 3 + 4 + 5);
    EXPECT_EQ(d.techniques().front().t, 2);
    EXPECT_FALSE(d.has_choice(1));
    EXPECT_TRUE(d.has_choice(2));
}

TEST(TechniqueDistribution, SamplesWithItsProbabilities) {
    TechniqueDistribution d(1, 5);
    d.fit(some_energies(d.techniques().size()), 0.05);
    std::vector<double> expected, observed(d.techniques().size(), 0.0);
    constexpr int n = 200000;
    double sum = 0;
    for (const Technique& t : d.techniques()) {
        EXPECT_GT(d.probability(t.k, t.t), 0);
        expected.push_back(n * d.probability(t.k, t.t));
        sum += d.probability(t.k, t.t);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    Rng rng(5);
    for (int i = 0; i < n; ++i) {
        const Technique t = d.sample(rng.uniform());
        ++observed[d.index(t.k, t.t)];
    }
    EXPECT_GT(chi_square_p_value(expected, observed), sidak_level(family_level, 3));
}

TEST(TechniqueDistribution, SamplesTechniquesOfAGivenLength) {
    TechniqueDistribution d(1, 5);
    d.fit(some_energies(d.techniques().size()), 0.05);
    Rng rng(7);
    EXPECT_EQ(d.sample_given_length(1, rng.uniform()), 2);
    constexpr int k = 4, n = 100000;
    std::vector<double> expected = {0}, observed(k + 2, 0.0);
    for (int t = 1; t <= k + 1; ++t) expected.push_back(n * d.probability_given_length(k, t));
    for (int i = 0; i < n; ++i) ++observed[d.sample_given_length(k, rng.uniform())];
    EXPECT_GT(chi_square_p_value(expected, observed), sidak_level(family_level, 3));
}

TEST(TechniqueDistribution, AnotherTechniqueComesInProportionAndIsNeverTheSame) {
    TechniqueDistribution d(2, 5);
    d.fit(some_energies(d.techniques().size()), 0.05);
    constexpr int k = 5, t = 3, n = 100000;
    std::vector<double> expected, observed(k + 2, 0.0);
    const double others = 1 - d.probability_given_length(k, t);
    for (int other = 0; other <= k + 1; ++other)
        expected.push_back(other == 0 || other == t ? 0 : n * d.probability_given_length(k, other) / others);
    Rng rng(6);
    for (int i = 0; i < n; ++i) ++observed[d.sample_other(k, t, rng.uniform())];
    EXPECT_EQ(observed[t], 0);
    EXPECT_GT(chi_square_p_value(expected, observed), sidak_level(family_level, 3));
}

// Every length gets the same time, every technique of a length the same share: k P(k, t) n_k is constant.
TEST(TechniqueDistribution, GivesEveryLengthTheSameTimeWithoutEnergy) {
    for (const bool fitted : {false, true}) {
        TechniqueDistribution d(1, 3);
        if (fitted) d.fit(std::vector<double>(d.techniques().size(), 0.0), 0.05);
        const double per_length = 1 / (1 + 1.0 / 2 + 1.0 / 3);
        EXPECT_DOUBLE_EQ(d.probability(1, 2), per_length);
        for (int t = 1; t <= 3; ++t) EXPECT_DOUBLE_EQ(d.probability(2, t), per_length / 2 / 3);
        for (int t = 1; t <= 4; ++t) EXPECT_DOUBLE_EQ(d.probability(3, t), per_length / 3 / 4);
    }
}

}  // namespace
}  // namespace keyhole
