// The chain on a target on the unit interval, and what it does with weights, failures and saved states.
#include "chain/metropolis.h"

#include <gtest/gtest.h>

#include <limits>

#include "chain/running_mean.h"
#include "interval_target.h"
#include "statistics.h"

namespace keyhole {
namespace {

using RealMixture = Mixture<double, Rng>;
using Components = std::vector<RealMixture::Component>;

Proposal wrapped_step(double& x, double& y, Rng& random) {
    y = wrapped(x + draw_triangular(0.2, random));
    return symmetric_proposal(x, y);
}

Proposal reflected_step(double& x, double& y, Rng& random) {
    y = reflected(x + draw_triangular(0.5, random));
    return symmetric_proposal(x, y);
}

Proposal uniform_draw(double& x, double& y, Rng& random) {
    y = random.uniform();
    return symmetric_proposal(x, y);
}

RealMixture three_steps() {
    Components c;
    add<double>(c, 0.5, wrapped_step);
    add<double>(c, 0.4, reflected_step, [](double x) { return x < 0.6 ? 1.0 : 0.1; });
    add<double>(c, 0.1, uniform_draw);
    return RealMixture(std::move(c));
}

double p_value_on_interval(const RealMixture& mixture, std::uint64_t seed, int steps = 10) {
    constexpr int chains = 100000;
    Histogram<double> reached(interval_cells, interval_cell);
    run_chains<double>(mixture, draw_from_interval_target, chains, steps, seed, reached);
    return chi_square_p_value(expected_in_cells(chains), reached.weights);
}

RealMixture single(FunctionStrategy<double>::Propose propose) {
    Components c;
    add<double>(c, 1, std::move(propose));
    return RealMixture(std::move(c));
}

TEST(Chain, KeepsATargetOnTheInterval) {
    EXPECT_GT(p_value_on_interval(three_steps(), 11), false_alarm);
    EXPECT_GT(p_value_on_interval(single(wrapped_step), 12), false_alarm);
    EXPECT_GT(p_value_on_interval(single(reflected_step), 13), false_alarm);
}

TEST(Chain, ReachesTheTargetFromAnyState) {
    constexpr int chains = 20000;
    Histogram<double> reached(interval_cells, interval_cell);
    run_chains<double>(
        three_steps(), [](Rng&) { return 0.69; }, chains, 100, 14, reached);
    EXPECT_GT(chi_square_p_value(expected_in_cells(chains), reached.weights), false_alarm);
}

TEST(Chain, NoticesAProposalThatIsNotSymmetric) {
    EXPECT_LT(p_value_on_interval(single([](double& x, double& y, Rng& random) {
                                      y = wrapped(x + draw_triangular(0.2, random) + 0.02 * x);
                                      return symmetric_proposal(x, y);
                                  }),
                                  15),
              clear_failure);
}

TEST(Chain, SplatsAreUnbiased) {
    // The weight that a cell gets in the steps of one chain from an exact start has the expectation steps * target.
    // Over independent chains its mean is normal to good approximation: one z-test for each cell.
    constexpr int chains = 20000, steps = 16;
    const RealMixture mixture = three_steps();
    std::vector<RunningMean> cells(interval_cells);
    Diagnostics diagnostics(mixture.size());
    for (std::uint64_t i = 0; i < chains; ++i) {
        Rng random(17, i);
        Chain<double> chain(draw_from_interval_target(random));
        Histogram<double> film(interval_cells, interval_cell);
        for (int n = 0; n < steps; ++n) chain.step(mixture, random, film, diagnostics);
        chain.splat_held(film);
        double total = 0;
        for (std::size_t c = 0; c < interval_cells; ++c) {
            cells[c].add(film.weights[c]);
            total += film.weights[c];
        }
        ASSERT_NEAR(total, steps, 1e-12 * steps);  // rounding of 2 * steps additions
    }
    const std::vector<double> expected = expected_in_cells(steps);
    for (std::size_t c = 0; c < interval_cells; ++c) {
        if (expected[c] == 0) {
            EXPECT_EQ(cells[c].mean(), 0);
            continue;
        }
        const double z = (cells[c].mean() - expected[c]) / cells[c].standard_error();
        EXPECT_GT(chi_square_tail(z * z, 1), sidak_level(false_alarm, interval_cells)) << "cell " << c;
    }
}

// Remembers every splat.
struct Record {
    std::vector<std::pair<double, double>> splats;
    void splat(double state, double weight) { splats.emplace_back(state, weight); }
};

TEST(Chain, UsesOneAcceptanceValueForAcceptingAndSplatting) {
    const RealMixture mixture = single([](double& x, double& y, Rng&) {
        y = 1 - x;
        return Proposal{x < 0.5 ? 0.25 : 4.0};
    });
    Rng random(18, 0);
    Diagnostics diagnostics(1);
    Chain<double> chain(0.2);
    double held = 0;
    for (int n = 0; n < 1000; ++n) {
        Record film;
        const double x = chain.current();
        const StepOutcome outcome = chain.step(mixture, random, film, diagnostics);
        const double a = x < 0.5 ? 0.25 : 1;
        ASSERT_EQ(outcome.acceptance, a);
        ASSERT_EQ(chain.proposed(outcome), 1 - x);
        held += 1 - a;
        if (outcome.accepted) {  // x gets all it was held for and its part of this step, y starts with a
            ASSERT_EQ(film.splats.size(), held > 0 ? 1u : 0u);
            if (held > 0) {
                ASSERT_EQ(film.splats[0], std::make_pair(x, held));
            }
            held = a;
            ASSERT_EQ(chain.current(), 1 - x);
        } else {
            ASSERT_EQ(film.splats, (std::vector<std::pair<double, double>>{{1 - x, a}}));
            ASSERT_EQ(chain.current(), x);
        }
        ASSERT_EQ(chain.held(), held);
    }
    const double accepted = static_cast<double>(diagnostics.total().accepted);
    EXPECT_EQ(diagnostics.total().proposals, 1000u);
    // Expected 400 (two fifths of the steps are from the right, a fifth of the others succeed); the standard
    // deviation is 10, and 50 either way is a false alarm with 6e-7.
    EXPECT_NEAR(accepted, 400, 50);
}

TEST(Chain, RejectsAndCountsWhatIsNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, inf, -inf, -1e-300}) {
        const RealMixture mixture = single([bad](double&, double& y, Rng&) {
            y = 0.9;
            return Proposal{bad};
        });
        Rng random(19, 0);
        Diagnostics diagnostics(1);
        Record film;
        Chain<double> chain(0.1);
        const StepOutcome outcome = chain.step(mixture, random, film, diagnostics);
        EXPECT_EQ(outcome.failure, Failure::non_finite) << bad;
        EXPECT_EQ(outcome.acceptance, 0);
        EXPECT_FALSE(outcome.accepted);
        EXPECT_EQ(chain.current(), 0.1);
        EXPECT_EQ(chain.held(), 1);
        EXPECT_TRUE(film.splats.empty());
        EXPECT_EQ(diagnostics.strategies[0].failed(Failure::non_finite), 1u);
        EXPECT_EQ(diagnostics.strategies[0].accepted, 0u);
    }
}

TEST(Chain, CountsEveryFailureByItsKind) {
    for (std::size_t kind = 1; kind < failure_kinds; ++kind) {
        const auto failure = static_cast<Failure>(kind);
        const RealMixture mixture = single([failure](double&, double&, Rng&) { return Proposal{1, failure}; });
        Rng random(20, 0);
        Diagnostics diagnostics(1);
        NoFilm film;
        Chain<double> chain(0.1);
        EXPECT_EQ(chain.step(mixture, random, film, diagnostics).failure, failure);
        EXPECT_EQ(diagnostics.strategies[0].failed(failure), 1u) << failure_name(failure);
        EXPECT_EQ(chain.held(), 1);
    }
}

TEST(Chain, ContinuesFromASavedState) {
    const RealMixture mixture = three_steps();
    Rng random(21, 0);
    Diagnostics diagnostics(mixture.size());
    Record before, after, restored_after;
    Chain<double> chain(0.3);
    for (int n = 0; n < 1000; ++n) chain.step(mixture, random, before, diagnostics);

    // The current state, the held weight and the position of the random numbers are all that there is to save.
    Chain<double> restored(chain.current(), chain.held());
    Rng restored_random(random.state());
    Diagnostics restored_diagnostics = diagnostics;
    for (int n = 0; n < 1000; ++n) {
        chain.step(mixture, random, after, diagnostics);
        restored.step(mixture, restored_random, restored_after, restored_diagnostics);
    }
    EXPECT_EQ(after.splats, restored_after.splats);
    EXPECT_EQ(chain.current(), restored.current());
    EXPECT_EQ(chain.held(), restored.held());
    EXPECT_EQ(diagnostics, restored_diagnostics);
    EXPECT_GT(after.splats.size(), 500u);
}

TEST(Chain, CopiesAreIndependent) {
    const RealMixture mixture = three_steps();
    Rng random(22, 0);
    Diagnostics diagnostics(mixture.size());
    NoFilm film;
    Chain<double> chain(0.3);
    for (int n = 0; n < 101; ++n) chain.step(mixture, random, film, diagnostics);
    const Chain<double> copy = chain;
    const double state = chain.current();
    for (int n = 0; n < 101; ++n) chain.step(mixture, random, film, diagnostics);
    EXPECT_NE(chain.current(), state);
    EXPECT_EQ(copy.current(), state);
}

TEST(Chain, SplattingWhatIsHeldLeavesTheChainAsItIs) {
    const RealMixture mixture = three_steps();
    Rng random(23, 0), same_random(23, 0);
    Diagnostics diagnostics(mixture.size());
    Chain<double> chain(0.3), previewed(0.3);
    Record film, previewed_film, preview;
    for (int n = 0; n < 200; ++n) {
        chain.step(mixture, random, film, diagnostics);
        previewed.step(mixture, same_random, previewed_film, diagnostics);
        previewed.splat_held(preview);
    }
    EXPECT_EQ(film.splats, previewed_film.splats);
    EXPECT_EQ(preview.splats.back(), std::make_pair(chain.current(), chain.held()));
}

}  // namespace
}  // namespace keyhole
