// The normalisation of a target by bridge sampling, on states with known targets.
#include "chain/normalization.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/rng.h"

namespace keyhole {
namespace {

// Samples find nothing in the first state, weights of about 10 in the next four, and once in 10^5 one of 10^6, which
// has half of b.
constexpr double rare = 1e-5;
constexpr std::array<double, 6> density = {0.4, 0.15, 0.15, 0.15, 0.15 - rare, rare};
constexpr std::array<double, 6> target = {0, 1, 2, 3, 4, 10};
constexpr double exact_b = 20;

double weight(std::size_t i) { return target[i] / density[i]; }

std::size_t draw(const std::array<double, 6>& weights, double total, Rng& random) {
    double left = random.uniform() * total;
    std::size_t i = 0;
    while (i + 1 < weights.size() && (left -= weights[i]) >= 0) ++i;
    return i;
}

TEST(Normalization, IsExactInExpectationForEveryScale) {
    for (const double scale : {1e-9, 0.3, 1e3, 1e12}) {
        const BridgeFunction a{scale};
        double samples = 0, states = 0;
        for (std::size_t i = 0; i < target.size(); ++i) {
            samples += density[i] * weight(i) * a(weight(i));
            states += target[i] / exact_b * a(weight(i));
        }
        EXPECT_NEAR(samples / states / exact_b, 1, 1e-14) << scale;
    }
}

TEST(Normalization, IsTheMeanOfTheWeightsAsLongAsThereAreNoStates) {
    Normalization b;
    for (const double w : {3.0, 0.0}) b.add_sample(w, BridgeFunction{0.1});
    EXPECT_EQ(b.b(), 1.5);
}

TEST(Normalization, MergesToTheSame) {
    Rng random(1, 0);
    Normalization all, parts[3];
    for (int i = 0; i < 300; ++i) {
        const double sample = random.uniform(), state = random.uniform();
        for (Normalization* n : {&all, &parts[i % 3]}) {
            n->add_sample(sample, BridgeFunction{0.2});
            n->add_state(state, BridgeFunction{0.2});
        }
    }
    parts[0].merge(parts[1]);
    parts[0].merge(parts[2]);
    EXPECT_NEAR(parts[0].b() / all.b(), 1, 1e-13);  // rounding of 300 additions
}

// Of 10^4 samples one is the heavy one in one run of ten: the mean of the weights has half of b in the others and five
// times as much in that one. The bridge knows b from the states. With a = 0.001 of the heavy state and 0.97 to 1 of the
// others, the mean of a over 10^4 states has a relative standard deviation of 0.01, and that of w a over the samples
// one of 0.01, to which each heavy one adds 0.01: 0.1 is seven standard deviations, a false alarm of 1e-9 in 100 runs.
TEST(Normalization, KnowsWhatSamplesHaveNotFound) {
    constexpr int n = 10000;
    int mean_near = 0, heavy = 0;
    for (std::uint64_t run = 0; run < 100; ++run) {
        Rng random(2, run);
        std::vector<double> weights(n);
        for (double& w : weights) w = weight(draw(density, 1, random));
        const BridgeFunction a = bridge_for(weights, 100);
        Normalization b;
        for (const double w : weights) b.add_sample(w, a);
        for (int i = 0; i < n; ++i) b.add_state(weight(draw(target, exact_b, random)), a);
        EXPECT_NEAR(b.b() / exact_b, 1, 0.1) << run;
        mean_near += std::abs(b.weights.mean() / exact_b - 1) < 0.1;
        heavy += b.weights.mean() > 2 * exact_b;
    }
    EXPECT_EQ(mean_near, 0);
    EXPECT_GT(heavy, 0);
}

// Without heavy samples the states have next to no say.
TEST(Normalization, IsTheMeanWhereNoSampleIsHeavy) {
    Rng random(3, 0);
    std::vector<double> weights(10000);
    for (double& w : weights) w = random.uniform() < 0.5 ? 0 : random.uniform();
    const BridgeFunction a = bridge_for(weights, 100);
    Normalization b;
    for (const double w : weights) b.add_sample(w, a);
    b.add_state(0.9, a);
    EXPECT_NEAR(b.b() / b.weights.mean(), 1, 0.02);
}

}  // namespace
}  // namespace keyhole
