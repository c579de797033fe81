// The interface of a mutation strategy: one Metropolis-Hastings kernel of a mixture.
#pragma once

#include <concepts>
#include <string_view>

#include "chain/outcome.h"

namespace keyhole {

// A source of random numbers; uniform() is in [0, 1).
template <class T>
concept RandomSource = requires(T& random) {
    { random.uniform() } -> std::convertible_to<double>;
};

// A strategy is shared by all chains and threads: it does not change once it is made, and what a proposal needs
// to remember belongs into the proposed state.
template <class State, RandomSource Random>
class Strategy {
  public:
    virtual ~Strategy() = default;

    virtual std::string_view name() const = 0;

    // Proposes a move of the chain from `current` and writes all of the proposed state to `proposed` (which holds an
    // unrelated old state, for reuse of its memory).
    //
    // The kernel must leave the chain's target invariant together with the returned ratio. Inner stages (delayed
    // rejection, a walk through states without contribution) end in one proposal and its completed ratio.
    //
    // `current` keeps its value. Only what is drawn on demand may be filled in, given that value: auxiliary variables
    // from their conditional distribution, or cached results.
    virtual Proposal propose(State& current, State& proposed, Random& random) const = 0;

    // How well the strategy applies to a state, >= 0; zero: not at all. It scales the strategy's weight in the mixture.
    // Must depend on nothing but the state's value. A strategy that overrides it returns true from
    // `suitability_varies`; others cost the mixture nothing.
    virtual double suitability(const State&) const { return 1; }
    virtual bool suitability_varies() const { return false; }
};

}  // namespace keyhole
