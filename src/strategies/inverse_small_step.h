// Inverse primary-space perturbation [Pantaleoni 2017, section 4.3]: a move of a path whose chart does not matter, by a
// small step in a chart drawn for it.
#pragma once

#include "strategies/chart_swap.h"

namespace keyhole {

// t ~ q(t | k) among the techniques that can make x, whose sum is Q(x); u = R_t(x), u' = u + symmetric step, y =
// T_t(u'):
//     r = [f*(y) / p_t(y)] / [f*(x) / p_t(x)]  Q(x) / Q(y),  f* / p_t = C / w_t.
// Refused where R_t has no coordinates for y, since the way back would be missing.
//
// The state forgets its chart: which technique made y says nothing of the technique that it would have in equilibrium.
template <class Kernel>
class InverseSmallStep final : public PssStrategy {
  public:
    InverseSmallStep(ChartEvaluator& charts, const TechniqueDistribution& techniques, const Kernel& kernel)
        : charts_(charts), techniques_(techniques), kernel_(kernel), u_(charts.layout()) {}
    std::string_view name() const override { return "inverse-small-step"; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

  private:
    ChartEvaluator& charts_;
    const TechniqueDistribution& techniques_;
    Kernel kernel_;
    mutable PrimarySample u_;
};

extern template class InverseSmallStep<KelemenKernel>;
extern template class InverseSmallStep<GaussianKernel>;

}  // namespace keyhole
