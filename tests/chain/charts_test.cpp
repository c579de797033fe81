// Two coordinate systems ("charts") of one state: the chain core takes swaps between them as a strategy like any other.
#include <gtest/gtest.h>

#include <cmath>

#include "chain/metropolis.h"
#include "interval_target.h"
#include "statistics.h"

namespace keyhole {
namespace {

// Chart 0 samples x = u, chart 1 samples x = u^4; their densities are p_t(x).
struct ChartState {
    int chart = 0;
    double u = 0;

    double x() const { return chart == 0 ? u : u * u * u * u; }
};

double chart_pdf(int chart, double x) { return chart == 0 ? 1 : 0.25 * std::pow(x, -0.75); }
double chart_inverse(int chart, double x) { return chart == 0 ? x : std::sqrt(std::sqrt(x)); }

// C(x) = f(x) / sum_t p_t(x): the target of the chart's coordinates.
double chart_target(double x) { return interval_target(x) / (chart_pdf(0, x) + chart_pdf(1, x)); }

Proposal step_in_chart(ChartState& current, ChartState& proposed, Rng& random) {
    proposed = {current.chart, wrapped(current.u + draw_triangular(0.3, random))};
    const double target = chart_target(proposed.x());
    if (!(target > 0)) return Proposal::failed(Failure::zero_bsdf);
    return {target / chart_target(current.x())};
}

// Same x in the other chart: ratio p_t'(x) / p_t(x).
Proposal swap_chart(ChartState& current, ChartState& proposed, Rng&) {
    const int other = 1 - current.chart;
    const double x = current.x();
    proposed = {other, clamp01(chart_inverse(other, x))};
    return {chart_pdf(other, x) / chart_pdf(current.chart, x)};
}

// The same swap, forgetting that the charts have different densities.
Proposal careless_swap(ChartState& current, ChartState& proposed, Rng& random) {
    swap_chart(current, proposed, random);
    return {1};
}

// Draws x from the target and the chart from its conditional p_t(x) / sum p.
ChartState draw_chart_state(Rng& random) {
    const double x = draw_from_interval_target(random);
    const double weight = chart_pdf(0, x) / (chart_pdf(0, x) + chart_pdf(1, x));
    const int chart = random.uniform() < weight ? 0 : 1;
    return {chart, clamp01(chart_inverse(chart, x))};
}

double p_value_with_swap(FunctionStrategy<ChartState>::Propose swap, std::uint64_t seed) {
    std::vector<Mixture<ChartState, Rng>::Component> c;
    add<ChartState>(c, 1, step_in_chart, [](const ChartState& s) { return s.chart == 0 ? 1.0 : 0.0; });
    add<ChartState>(c, 4, step_in_chart, [](const ChartState& s) { return s.chart == 1 ? 1.0 : 0.0; });
    add<ChartState>(c, 2, std::move(swap));
    const Mixture<ChartState, Rng> mixture(std::move(c));
    constexpr int chains = 50000, steps = 20;
    Histogram<ChartState> reached(interval_cells, [](const ChartState& s) { return interval_cell(s.x()); });
    run_chains<ChartState>(mixture, draw_chart_state, chains, steps, seed, reached);
    return chi_square_p_value(expected_in_cells(chains), reached.weights);
}

TEST(Charts, SwapsKeepTheTarget) { EXPECT_GT(p_value_with_swap(swap_chart, 31), false_alarm); }

TEST(Charts, SwapsWithoutTheDensitiesDoNot) { EXPECT_LT(p_value_with_swap(careless_swap, 31), clear_failure); }

}  // namespace
}  // namespace keyhole
