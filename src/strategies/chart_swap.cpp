#include "strategies/chart_swap.h"

namespace keyhole {

Proposal ChartSwap::propose(PssState& x, PssState& y, Rng& rng) const {
    const int k = x.u.k, t = x.u.t;
    const int other = techniques_.sample_other(k, t, rng.uniform());
    const Scene& scene = chart_.tracer().scene();
    const auto find = [&](int technique, PrimarySample& u) {
        return invert(scene, chart_.window(), chart_.layout(), path_, technique, u, rng).failure ==
               InverseFailure::none;
    };

    const double weight = chart_.evaluate(x.u).weight;
    path_.assign(chart_.eye().begin(), chart_.eye().end());
    path_.insert(path_.end(), chart_.light().rbegin(), chart_.light().rend());
    if (!find(other, y.u) || !find(t, unread_)) return Proposal::failed(Failure::inverse_failed);
    const Evaluation e = chart_.evaluate(y.u);
    if (e.failure != PathFailure::none || !(deviation(chart_, path_) < largest_deviation))
        return Proposal::failed(Failure::inverse_failed);
    y.set(e);
    return {y.target / x.target * (e.weight / weight) * ratio_of_choices(k, t, other), Failure::none};
}

}  // namespace keyhole
