// The mixture: chains on eight states under strategies whose suitability depends on the state.
#include "chain/mixture.h"

#include <gtest/gtest.h>

#include <limits>

#include "statistics.h"
#include "targets.h"

namespace keyhole {
namespace {

using IntMixture = Mixture<int, Rng>;
using Components = std::vector<IntMixture::Component>;

constexpr int states = 8;
const std::vector<double> target = scaled({1, 5, 2, 8, 1, 3, 0.5, 4}, 1);

double target_ratio(int x, int y) { return target[static_cast<std::size_t>(y)] / target[static_cast<std::size_t>(x)]; }

// To a neighbour on the ring: up with probability 0.7, so that the proposal's own densities do not cancel.
Proposal step_on_ring(int& x, int& y, Rng& random) {
    const bool up = random.uniform() < 0.7;
    y = (x + (up ? 1 : states - 1)) % states;
    return {target_ratio(x, y) * (up ? 0.3 / 0.7 : 0.7 / 0.3)};
}

Proposal jump(int& x, int& y, Rng& random) {
    y = static_cast<int>(random.below(states));
    return {target_ratio(x, y)};
}

// Swaps pairs of states; fails for the last pair.
Proposal swap_in_pair(int& x, int& y, Rng&) {
    if (x >= 6) return Proposal::failed(Failure::occluded);
    y = x ^ 1;
    return {target_ratio(x, y)};
}

Components with_varying_suitability() {
    Components c;
    add<int>(c, 1, jump, [](int x) { return x % 2 == 0 ? 1.0 : 0.2; });
    add<int>(c, 3, step_on_ring, [](int x) { return x < 5 ? 1.0 : 0.0; });
    add<int>(c, 2, swap_in_pair);
    return c;
}

template <class MixtureType>
double p_value_of_reached_states(const MixtureType& mixture, std::uint64_t seed) {
    constexpr int chains = 100000, steps = 12;
    Histogram<int> reached(states, [](int x) { return static_cast<std::size_t>(x); });
    run_chains<int>(
        mixture, [](Rng& random) { return static_cast<int>(draw(target, random)); }, chains, steps, seed, reached);
    return chi_square_p_value(scaled(target, chains), reached.weights);
}

TEST(Mixture, KeepsTheTargetWithConstantSuitabilities) {
    Components c;
    add<int>(c, 1, jump);
    add<int>(c, 3, step_on_ring);
    add<int>(c, 2, swap_in_pair);
    EXPECT_GT(p_value_of_reached_states(IntMixture(std::move(c)), 1), false_alarm);
}

TEST(Mixture, KeepsTheTargetWithVaryingSuitabilities) {
    EXPECT_GT(p_value_of_reached_states(IntMixture(with_varying_suitability()), 2), false_alarm);
}

TEST(Mixture, WithoutTheReverseSelectionProbabilityTheTargetIsMissed) {
    EXPECT_LT(p_value_of_reached_states(ForgetfulMixture<int>(with_varying_suitability()), 2), clear_failure);
}

TEST(Mixture, TransitionsAreInDetailedBalance) {
    const FlowBalance balance = flow_balance<int>(
        IntMixture(with_varying_suitability()), [](Rng& random) { return static_cast<int>(draw(target, random)); },
        200000, 3, states, [](int x) { return static_cast<std::size_t>(x); });
    EXPECT_GE(balance.pairs, 20);
    EXPECT_GT(chi_square_tail(balance.statistic, balance.pairs), false_alarm);
}

TEST(Mixture, SelectsWithTheProbabilitiesThatItReports) {
    const IntMixture mixture(with_varying_suitability());
    constexpr int draws = 100000;
    for (int x = 0; x < states; ++x) {
        Rng random(4, static_cast<std::uint64_t>(x));
        std::vector<double> expected, observed(mixture.size());
        for (std::size_t i = 0; i < mixture.size(); ++i) expected.push_back(draws * mixture.probability(i, x));
        for (int n = 0; n < draws; ++n) {
            const auto selection = mixture.select(x, random);
            ASSERT_EQ(selection.probability, mixture.probability(selection.index, x));
            ++observed[selection.index];
        }
        EXPECT_GT(chi_square_p_value(expected, observed), sidak_level(false_alarm, states)) << "state " << x;
    }
    // By hand: state 6 has jump 1 * 1, no step on the ring, swap 2 * 1; state 1 has 0.2, 3 and 2.
    EXPECT_DOUBLE_EQ(mixture.probability(0, 6), 1.0 / 3);
    EXPECT_EQ(mixture.probability(1, 6), 0);
    EXPECT_DOUBLE_EQ(mixture.probability(1, 1), 3 / 5.2);
}

TEST(Mixture, ScalesAllWeightsAlike) {
    Components small, large;
    for (const double scale : {1e-3, 1e3}) {
        Components& c = scale < 1 ? small : large;
        add<int>(c, 1 * scale, jump);
        add<int>(c, 3 * scale, step_on_ring);
    }
    const IntMixture a(std::move(small)), b(std::move(large));
    EXPECT_DOUBLE_EQ(a.probability(1, 0), 0.75);
    EXPECT_DOUBLE_EQ(b.probability(1, 0), 0.75);
}

TEST(Mixture, NeverSelectsAStrategyOfWeightZero) {
    Components c;
    add<int>(c, 0, step_on_ring);
    add<int>(c, 1, jump);
    add<int>(c, 0, swap_in_pair);
    const IntMixture mixture(std::move(c));
    Rng random(5, 0);
    for (int n = 0; n < 1000; ++n) ASSERT_EQ(mixture.select(0, random).index, 1u);
}

TEST(Mixture, StaysWhereNoStrategyApplies) {
    Components c;
    add<int>(c, 1, jump, [](int x) { return x == 0 ? 0.0 : 1.0; });
    const IntMixture mixture(std::move(c));
    Rng random(6, 0);
    Diagnostics diagnostics(1);
    Histogram<int> film(states, [](int x) { return static_cast<std::size_t>(x); });
    Chain<int> stuck(0), moving(3);
    for (int n = 0; n < 100; ++n) {
        EXPECT_TRUE(stuck.step(mixture, random, film, diagnostics).idle);
        moving.step(mixture, random, film, diagnostics);  // must not move to a state that it could not leave
        ASSERT_NE(moving.current(), 0);
    }
    EXPECT_EQ(stuck.current(), 0);
    EXPECT_EQ(stuck.held(), 100);
    EXPECT_EQ(diagnostics.idle, 100u);
    EXPECT_EQ(diagnostics.total().proposals, 100u);
}

TEST(Mixture, RefusesWeightsThatMakeNoDistribution) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {-1.0, nan, inf, 0.0}) {
        Components c;
        add<int>(c, bad, jump);
        EXPECT_THROW(IntMixture{std::move(c)}, std::invalid_argument) << bad;
    }
    EXPECT_THROW(IntMixture{Components{}}, std::invalid_argument);
    Components many;
    for (std::size_t i = 0; i <= IntMixture::max_size; ++i) add<int>(many, 1, jump);
    EXPECT_THROW(IntMixture{std::move(many)}, std::invalid_argument);
}

}  // namespace
}  // namespace keyhole
