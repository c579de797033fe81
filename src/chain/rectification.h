// What follows a proposal that fails: one without a proposed state, or whose target is zero (theory, section 5).
#pragma once

#include "chain/outcome.h"

namespace keyhole {

enum class Rectification {
    off,      // the current state counts once more: Metropolis-Hastings
    exclude,  // nothing counts and the step is drawn again, as published [Zeng et al. 2019]. Biased: the chain
              // converges to f Z, Z(x) = the probability that a proposal from x does not fail
    walk_on,  // exact: on from the failed point by the same symmetric step
    retry     // exact: a second, smaller step about the current state
};

struct RectificationSettings {
    Rectification policy = Rectification::off;
    int walk_steps = 4;         // of walk-on: steps in all, the first one included
    double retry_scale = 0.25;  // of retry: the second step's size in units of the first one's

    bool operator==(const RectificationSettings&) const = default;
};

// How often `exclude` draws a step again before it counts as rejected after all: a chain must end.
inline constexpr int most_redraws = 1'000'000;

// Where the first of a chain of steps has failed, by `failure`: makes more of them until one does not, `steps` in all
// at most. step() goes on by one symmetric step, through points that failed, and returns what became of it.
//
// The walk x -> y_1 -> ... -> y_m has the same density backwards, and there too y_m is the first point that does not
// fail: so the ratio is that of a single symmetric step, f(y_m) / f(x).
template <class Step>
Proposal walk_on(Proposal proposal, int steps, const Step& step) {
    const Failure first = proposal.failure;
    for (int i = 1; i < steps && proposal.failure != Failure::none; ++i) proposal = step();
    proposal.first_failure = first;
    return proposal;
}

// Delayed rejection [Tierney and Mira 1999] after a first step that has failed: `second` is the proposal of a symmetric
// second step about x with the ratio f(y_2) / f(x), and `densities` = q_1(y_2, y_1) / q_1(x, y_1) with the first
// kernel's densities of the SAME failed point y_1; 1 where the first kernel is independent of the state.
inline Proposal retried(Failure first, Proposal second, double densities) {
    second.first_failure = first;
    second.ratio *= densities;
    return second;
}

}  // namespace keyhole
