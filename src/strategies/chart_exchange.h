// Replica exchange between two chains in different charts [Pantaleoni 2017, section 4.1]: each takes over the path of
// the other and keeps its own technique.
#pragma once

#include "strategies/chart_evaluator.h"
#include "strategies/mmlt.h"

namespace keyhole {

// Chains a and b with techniques t and t' of one length, at x and x'. Their joint target is the product of theirs, so
//     r = [w_t(x') f*(x') w_t'(x) f*(x)] / [w_t(x) f*(x) w_t'(x') f*(x')] = [w_t(x') w_t'(x)] / [w_t(x) w_t'(x')].
// Chains that may exchange are found by length and technique alone, which no exchange changes.
class ChartExchange {
  public:
    explicit ChartExchange(ChartEvaluator& charts) : charts_(charts) {}

    // Both know their technique, have the same length and different techniques. Sets `new_a` to b's path by a's
    // technique and `new_b` to a's path by b's.
    Proposal propose(PssState& a, PssState& b, PssState& new_a, PssState& new_b, Rng& rng) const;

  private:
    ChartEvaluator& charts_;
};

}  // namespace keyhole
