// A Metropolis-Hastings chain. It knows its states only through the strategies that propose them.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <utility>

#include "chain/diagnostics.h"
#include "chain/mixture.h"

namespace keyhole {

// Takes a chain's weighted states: the film, or a histogram in a test.
template <class T, class State>
concept Sink = requires(T& sink, const State& state, double weight) {
    sink.splat(state, weight);
};

struct StepOutcome {
    std::size_t strategy = 0;               // its index in the mixture
    Failure failure = Failure::none;        // other than `none`: nothing was proposed
    Failure first_failure = Failure::none;  // other than `none`: the first stage failed, and there was a second one
    double acceptance = 0;                  // the probability with which the proposal was accepted
    bool accepted = false;
    bool idle = false;      // no strategy applies to the state; `strategy` is meaningless
    bool excluded = false;  // nothing counts
};

// A chain's value is its current state and the weight it still holds; with the state of the random numbers that is all
// there is to save. Copies are independent (the slots are told apart by an index, not by pointers into the chain).
template <class State>
class Chain {
  public:
    // `held`: as `held()` returned it when the chain was saved; 0 for a new chain.
    explicit Chain(State initial, double held = 0) : slots_{initial, std::move(initial)}, held_(held) {}

    const State& current() const { return slots_[current_]; }
    double held() const { return held_; }

    // The state that the last step proposed, accepted or not. Unspecified if it failed.
    const State& proposed(const StepOutcome& outcome) const {
        return slots_[outcome.accepted ? current_ : 1 - current_];
    }
    // The state that the last step started from.
    const State& previous(const StepOutcome& outcome) const {
        return slots_[outcome.accepted ? 1 - current_ : current_];
    }

    // A move from outside of the mixture, between steps: it is written to `spare()`. Such a move has no
    // weight of its own.
    State& current() { return slots_[current_]; }
    State& spare() { return slots_[1 - current_]; }
    template <Sink<State> Film>
    void leave_for_spare(Film& film) {
        splat_held(film);
        current_ = 1 - current_;
        held_ = 0;
    }

    // One step. Every step has the weight one: with the acceptance probability a, the current state gets 1 - a and the
    // proposed one a, whichever becomes the next. The current state's weight is held until it is left, so
    // that at most one state is splatted in a step.
    //
    // `mixture` is a Mixture<State, Random>, or anything with its select, strategy and completed_ratio. With
    // `excludes_failures` a step that fails is none: the current state gets no weight for it (Rectification::exclude).
    // A ratio that is negative, infinite or NaN counts as Failure::non_finite and is rejected.
    template <class MixtureType, RandomSource Random, Sink<State> Film>
    StepOutcome step(const MixtureType& mixture, Random& random, Film& film, Diagnostics& diagnostics,
                     bool excludes_failures = false) {
        State& x = slots_[current_];
        State& y = slots_[1 - current_];
        StepOutcome outcome;
        const auto selection = mixture.select(x, random);
        if (!(selection.probability > 0)) {
            held_ += 1;
            ++diagnostics.idle;
            outcome.idle = true;
            return outcome;
        }
        outcome.strategy = selection.index;
        Proposal proposal = mixture.strategy(selection.index).propose(x, y, random);
        if (proposal.failure == Failure::none) proposal.ratio = mixture.completed_ratio(proposal.ratio, selection, y);
        outcome.acceptance = acceptance(proposal);
        outcome.failure = proposal.failure;
        outcome.first_failure = proposal.first_failure;
        if (excludes_failures && lacks_contribution(outcome.failure)) {
            outcome.excluded = true;
            diagnostics.strategies[selection.index].exclude(outcome.failure);
            return outcome;
        }
        const double a = outcome.acceptance;
        outcome.accepted = a >= 1 || (a > 0 && random.uniform() < a);
        held_ += 1 - a;
        // The state that is not kept has all the weight that it will ever get.
        const double weight = outcome.accepted ? held_ : a;
        if (weight > 0) film.splat(outcome.accepted ? x : y, weight);
        if (outcome.accepted) {
            current_ = 1 - current_;
            held_ = a;
        }
        diagnostics.strategies[selection.index].add(outcome.failure, a, outcome.accepted, outcome.first_failure);
        return outcome;
    }

    // Splats what the current state still holds. The chain is not changed: this is for a copy of the film (a preview)
    // or after the last step, and no splat depends on how often it is called.
    template <Sink<State> Film>
    void splat_held(Film& film) const {
        if (held_ > 0) film.splat(slots_[current_], held_);
    }

  private:
    std::array<State, 2> slots_;
    std::size_t current_ = 0;
    double held_ = 0;
};

}  // namespace keyhole
