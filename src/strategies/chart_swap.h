// Moves between charts of one path.
#pragma once

#include <vector>

#include "inverse/inverse.h"
#include "strategies/mmlt.h"

namespace keyhole {

// The same path by another technique, with coordinates from the exact inverse [Bitterli et al. 2017; Pantaleoni 2017]:
//     r = [p_t'(x) / p_t(x)] times the ratio of the choices,
// with p_t' / p_t = w_t' / w_t. The re-traced path is what is accepted; it differs from x by rounding.
//
// A path that the inverse of t' fails at cannot be left towards t', and one that the inverse of t fails at cannot be
// left from t, since the way back would be missing (theory, section 4).
class ChartSwap final : public ToOtherTechnique {
  public:
    ChartSwap(Chart& chart, const TechniqueDistribution& techniques)
        : ToOtherTechnique(chart, techniques), unread_(chart.layout()) {
        path_.reserve(static_cast<std::size_t>(chart.layout().max_length()) + 1);
    }
    std::string_view name() const override { return "chart-swap"; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

  private:
    // Room for one proposal: a strategy belongs to one thread.
    mutable std::vector<Vertex> path_;
    mutable PrimarySample unread_;  // coordinates of the path by its own technique, which show that there are any
};

}  // namespace keyhole
