// Small targets whose distribution is known, and the run of many independent chains from exact starting states: what
// they have reached after a few steps are independent samples of the target if, and only if, the kernel leaves it
// invariant. A chi-square test of such samples has exactly the false-alarm level that it is held against.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "chain/metropolis.h"

namespace keyhole {

// Level of a single test in this folder, and what is a clear failure where a broken kernel has to be noticed.
inline constexpr double false_alarm = 1e-4, clear_failure = 1e-10;

// A strategy made of functions.
template <class State>
class FunctionStrategy final : public Strategy<State, Rng> {
  public:
    using Propose = std::function<Proposal(State& x, State& y, Rng& random)>;
    using Suitability = std::function<double(const State& x)>;

    explicit FunctionStrategy(Propose propose, Suitability suitability = {})
        : propose_(std::move(propose)), suitability_(std::move(suitability)) {}

    std::string_view name() const override { return "function"; }
    Proposal propose(State& x, State& y, Rng& random) const override { return propose_(x, y, random); }
    double suitability(const State& x) const override { return suitability_ ? suitability_(x) : 1; }
    bool suitability_varies() const override { return static_cast<bool>(suitability_); }

  private:
    Propose propose_;
    Suitability suitability_;
};

// Adds a strategy to the components of a mixture.
template <class State>
void add(std::vector<typename Mixture<State, Rng>::Component>& components, double weight,
         typename FunctionStrategy<State>::Propose propose,
         typename FunctionStrategy<State>::Suitability suitability = {}) {
    components.push_back(
        {std::make_unique<FunctionStrategy<State>>(std::move(propose), std::move(suitability)), weight});
}

// Ignores what it is given.
struct NoFilm {
    template <class State>
    void splat(const State&, double) {}
};

// Sums the weight of each cell; `cell` says which cell a state is in.
template <class State>
struct Histogram {
    std::vector<double> weights;
    std::function<std::size_t(const State&)> cell;

    Histogram(std::size_t cells, std::function<std::size_t(const State&)> cell_of)
        : weights(cells), cell(std::move(cell_of)) {}
    void splat(const State& state, double weight) { weights[cell(state)] += weight; }
};

// Counts in `reached` where `chains` independent chains are after `steps` steps. `start` draws from the exact target,
// and `complete` what the last state leaves open.
template <class State, class MixtureType>
void run_chains(const MixtureType& mixture, const std::function<State(Rng&)>& start, int chains, int steps,
                std::uint64_t seed, Histogram<State>& reached, const std::function<void(State&, Rng&)>& complete = {}) {
    Diagnostics diagnostics(mixture.size());
    NoFilm film;
    for (int i = 0; i < chains; ++i) {
        Rng random(seed, static_cast<std::uint64_t>(i));
        Chain<State> chain(start(random));
        for (int n = 0; n < steps; ++n) chain.step(mixture, random, film, diagnostics);
        if (complete) complete(chain.current(), random);
        reached.splat(chain.current(), 1);
    }
}

// What a mixture would be that forgets the probability of choosing the strategy again for the way back.
template <class State>
class ForgetfulMixture : public Mixture<State, Rng> {
  public:
    using Mixture<State, Rng>::Mixture;
    double completed_ratio(double ratio, const typename Mixture<State, Rng>::Selection&, const State&) const {
        return ratio;
    }
};

// Detailed balance: how far the flows between cells of single steps from the exact target differ in their two
// directions. n_xy and n_yx over independent chains are binomial with 1/2 given their sum, so the sum over all pairs of
// (n_xy - n_yx)^2 / (n_xy + n_yx) is chi-square distributed.
struct FlowBalance {
    int pairs = 0;  // of cells with enough flow
    double statistic = 0;
};

template <class State, class MixtureType>
FlowBalance flow_balance(const MixtureType& mixture, const std::function<State(Rng&)>& start, int chains,
                         std::uint64_t seed, std::size_t cells, const std::function<std::size_t(const State&)>& cell,
                         const std::function<void(State&, Rng&)>& complete = {}) {
    std::vector<double> counts(cells * cells);
    Diagnostics diagnostics(mixture.size());
    NoFilm film;
    for (int i = 0; i < chains; ++i) {
        Rng random(seed, static_cast<std::uint64_t>(i));
        Chain<State> chain(start(random));
        const std::size_t before = cell(chain.current());
        chain.step(mixture, random, film, diagnostics);
        if (complete) complete(chain.current(), random);
        ++counts[before * cells + cell(chain.current())];
    }
    FlowBalance balance;
    for (std::size_t x = 0; x < cells; ++x) {
        for (std::size_t y = 0; y < x; ++y) {
            const double there = counts[x * cells + y], back = counts[y * cells + x];
            if (there + back < 20) continue;
            balance.statistic += (there - back) * (there - back) / (there + back);
            ++balance.pairs;
        }
    }
    return balance;
}

// Draws an index with the given probabilities (they sum to one).
inline std::size_t draw(std::span<const double> probabilities, Rng& random) {
    double u = random.uniform();
    for (std::size_t i = 0; i + 1 < probabilities.size(); ++i) {
        if (u < probabilities[i]) return i;
        u -= probabilities[i];
    }
    return probabilities.size() - 1;
}

// The values, scaled to the sum `total`.
inline std::vector<double> scaled(std::vector<double> values, double total) {
    const double factor = total / std::accumulate(values.begin(), values.end(), 0.0);
    for (double& v : values) v *= factor;
    return values;
}

}  // namespace keyhole
