// Moves between the charts of one path, with coordinates from the exact inverse [Bitterli et al. 2017; Pantaleoni
// 2017]. The re-traced path is what is accepted; it differs from x by rounding.
//
// A path that the inverse of t' fails at cannot be left towards t', and one that the inverse of t fails at cannot be
// left from t, since the way back would be missing (theory, section 4). Known limit: for t it is asked whether any inverse
// exists, not whether the one does that has the branches of the current coordinates. Where some branches of a path fail
// and others do not, that is not exact (tests/chain/branch_charts_test.cpp); `keyhole roundtrip` counts failures.
#pragma once

#include "strategies/chart_evaluator.h"
#include "strategies/mmlt.h"

namespace keyhole {

// What both have in common. The states keep their paths.
class ChartMove : public ToOtherTechnique {
  public:
    ChartMove(ChartEvaluator& evaluator, const TechniqueDistribution& techniques)
        : ToOtherTechnique(evaluator, techniques), charts_(evaluator) {}

  protected:
    ChartEvaluator& charts_;
};

// t' ~ q(t' | k), among the techniques other than t that can make the path; Q is the sum of q over all that can:
//     r = [p_t'(x) / p_t(x)] [q(t | k) / (Q - q(t' | k))] / [q(t' | k) / (Q - q(t | k))],  p_t' / p_t = w_t' / w_t.
class ChartSwap final : public ChartMove {
  public:
    using ChartMove::ChartMove;
    std::string_view name() const override { return "chart-swap"; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;
};

// t' ~ w_t'(x), its conditional distribution, so that r = 1: nothing is ever rejected, but for inverses that fail.
// Where t' = t, the state stays as it is (Failure::unchanged).
class ChartGibbs final : public ChartMove {
  public:
    using ChartMove::ChartMove;
    std::string_view name() const override { return "chart-gibbs"; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;
};

}  // namespace keyhole
