// What follows a failed proposal, on the interval target: its gap makes the probability of failing depend on the state.
#include "chain/rectification.h"

#include <gtest/gtest.h>

#include "chain/metropolis.h"
#include "interval_target.h"
#include "statistics.h"

namespace keyhole {
namespace {

using RealMixture = Mixture<double, Rng>;
constexpr double width = 0.4;

Proposal first_step(double& x, double& y, Rng& random) {
    y = wrapped(x + draw_triangular(width, random));
    return symmetric_proposal(x, y);
}

template <int steps>
Proposal step_and_walk_on(double& x, double& y, Rng& random) {
    return walk_on(first_step(x, y, random), steps, [&] {
        y = wrapped(y + draw_triangular(width, random));
        return symmetric_proposal(x, y);
    });
}

enum class FirstStep { small, independent };

template <FirstStep kind, bool with_densities>
Proposal step_and_retry(double& x, double& y, Rng& random) {
    Proposal first;
    if (kind == FirstStep::small) {
        first = first_step(x, y, random);
    } else {
        y = random.uniform();
        first = symmetric_proposal(x, y);
    }
    if (first.failure == Failure::none) return first;
    const double failed = y;
    y = wrapped(x + draw_triangular(width / 2, random));
    const auto density = [&](double a) { return triangular_pdf(wrapped_difference(a, failed), width); };
    return retried(first.failure, symmetric_proposal(x, y), with_densities ? density(y) / density(x) : 1);
}

RealMixture only(FunctionStrategy<double>::Propose propose) {
    std::vector<RealMixture::Component> c;
    add<double>(c, 1, std::move(propose));
    return RealMixture(std::move(c));
}

constexpr int chains = 100000, steps = 20;

double p_value(FunctionStrategy<double>::Propose propose, std::uint64_t seed) {
    Histogram<double> reached(interval_cells, interval_cell);
    run_chains<double>(only(std::move(propose)), draw_from_interval_target, chains, steps, seed, reached);
    return chi_square_p_value(expected_in_cells(chains), reached.weights);
}

TEST(Rectification, WalkingOnKeepsTheTarget) {
    EXPECT_GT(p_value(step_and_walk_on<2>, 41), false_alarm);
    EXPECT_GT(p_value(step_and_walk_on<8>, 42), false_alarm);
}

// Of a walk that goes on through points that did not fail, the last is not reached backwards in the same way.
TEST(Rectification, WalkingOnFromWhereverDoesNot) {
    const auto careless = [](double& x, double& y, Rng& random) {
        const Proposal first = first_step(x, y, random);
        if (first.failure == Failure::none) return first;
        y = wrapped(0.5 * (x + y) + draw_triangular(width, random));
        return symmetric_proposal(x, y);
    };
    EXPECT_LT(p_value(careless, 43), clear_failure);
}

TEST(Rectification, RetryingKeepsTheTarget) {
    EXPECT_GT(p_value(step_and_retry<FirstStep::small, true>, 44), false_alarm);
    EXPECT_GT(p_value(step_and_retry<FirstStep::independent, false>, 45), false_alarm);
}

TEST(Rectification, RetryingWithoutTheDensitiesDoesNot) {
    EXPECT_LT(p_value(step_and_retry<FirstStep::small, false>, 46), clear_failure);
}

// Z(x): the probability that a step from x ends outside of the gap [0.7, 0.85).
double success(double x) {
    constexpr int n = 200;
    double failure = 0;
    for (int i = 0; i < n; ++i)
        failure += triangular_pdf(wrapped_difference(x, 0.7 + 0.15 * (i + 0.5) / n), width) * 0.15 / n;
    return 1 - failure;
}

// The cells' shares of f Z, by the midpoint rule; f is smooth within cells.
std::vector<double> expected_with_exclusion(double total) {
    constexpr int n = 50;
    std::vector<double> mass(interval_cells);
    for (std::size_t c = 0; c < interval_cells; ++c)
        for (int i = 0; i < n; ++i) {
            const double u = (static_cast<double>(c) + (i + 0.5) / n) / interval_cells;
            mass[c] += interval_target(u) * success(u);
        }
    return scaled(mass, total);
}

// Chains that leave failures out, from f Z.
std::vector<double> reached_with_exclusion(std::uint64_t seed, StrategyCounts& counts) {
    const RealMixture mixture = only(first_step);
    Diagnostics diagnostics(1);
    NoFilm film;
    std::vector<double> reached(interval_cells);
    for (std::uint64_t i = 0; i < chains; ++i) {
        Rng random(seed, i);
        double start = draw_from_interval_target(random);
        while (random.uniform() >= success(start)) start = draw_from_interval_target(random);
        Chain<double> chain(start);
        for (int n = 0; n < steps;) n += !chain.step(mixture, random, film, diagnostics, true).excluded;
        reached[interval_cell(chain.current())] += 1;
    }
    counts = diagnostics.strategies[0];
    return reached;
}

TEST(Rectification, ExcludingConvergesToTheTargetTimesTheProbabilityOfSuccess) {
    StrategyCounts counts;
    const std::vector<double> reached = reached_with_exclusion(47, counts);
    EXPECT_GT(chi_square_p_value(expected_with_exclusion(chains), reached), false_alarm);
    EXPECT_LT(chi_square_p_value(expected_in_cells(chains), reached), clear_failure);
    EXPECT_EQ(counts.proposals - counts.excluded, static_cast<std::uint64_t>(chains) * steps);
    EXPECT_EQ(counts.failed(Failure::occluded), counts.excluded);
    EXPECT_EQ(counts.failed(Failure::none), static_cast<std::uint64_t>(chains) * steps);
}

// Weights are those of steps: what is excluded adds none.
TEST(Rectification, ExcludedProposalsHaveNoWeight) {
    const RealMixture mixture = only([](double&, double&, Rng&) { return Proposal::failed(Failure::occluded); });
    Rng random(48, 0);
    Diagnostics diagnostics(1);
    NoFilm film;
    Chain<double> chain(0.3);
    for (int n = 0; n < 10; ++n) EXPECT_TRUE(chain.step(mixture, random, film, diagnostics, true).excluded);
    EXPECT_EQ(chain.held(), 0);
    EXPECT_FALSE(chain.step(mixture, random, film, diagnostics).excluded);
    EXPECT_EQ(chain.held(), 1);
    EXPECT_EQ(diagnostics.strategies[0].excluded, 10u);
}

// The current state itself is no failure: leaving it out would bias even where everything contributes.
TEST(Rectification, ProposalsThatAreTheStateItselfCount) {
    const RealMixture mixture = only([](double&, double&, Rng&) { return Proposal::failed(Failure::unchanged); });
    Rng random(50, 0);
    Diagnostics diagnostics(1);
    NoFilm film;
    Chain<double> chain(0.3);
    EXPECT_FALSE(chain.step(mixture, random, film, diagnostics, true).excluded);
    EXPECT_EQ(chain.held(), 1);
    EXPECT_EQ(diagnostics.strategies[0].excluded, 0u);
}

TEST(Rectification, StagesAreCountedApart) {
    int calls = 0;
    const auto propose = [&](double&, double& y, Rng&) {
        y = 0.5;
        return walk_on(Proposal::failed(Failure::occluded), 4,
                       [&] { return ++calls % 3 == 0 ? Proposal{1} : Proposal::failed(Failure::zero_bsdf); });
    };
    const RealMixture mixture = only(propose);
    Rng random(49, 0);
    Diagnostics diagnostics(1);
    NoFilm film;
    Chain<double> chain(0.3);
    for (int n = 0; n < 10; ++n) {
        const StepOutcome outcome = chain.step(mixture, random, film, diagnostics);
        EXPECT_EQ(outcome.first_failure, Failure::occluded);
        EXPECT_EQ(outcome.failure, Failure::none);
    }
    const StrategyCounts& counts = diagnostics.strategies[0];
    EXPECT_EQ(calls, 30);
    EXPECT_EQ(counts.failed(Failure::occluded), 10u);
    EXPECT_EQ(counts.accepted, 10u);
    EXPECT_EQ(counts.second.proposals, 10u);
    EXPECT_EQ(counts.second.accepted, 10u);
    EXPECT_EQ(counts.mean_acceptance(), 1);
}

}  // namespace
}  // namespace keyhole
