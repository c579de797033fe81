#include "strategies/chart_swap.h"

namespace keyhole {

Proposal ChartSwap::propose(PssState& x, PssState& y, Rng& rng) const {
    if (!charts_.find_technique(x, rng)) return Proposal::failed(Failure::inverse_failed);
    const PossibleTechniques q{techniques_, charts_.weights(x)};
    const int own = x.u.t - 1;
    const double possible = q.sum(), q_own = q(own);
    const int other = draw_index(
        q.count(), possible - q_own, [&](int i) { return i == own ? 0 : q(i); }, rng);
    if (other < 0) return Proposal::failed(Failure::unchanged);
    const double q_other = q(other);
    const double ratio =
        q.weights[other] / q.weights[own] * (q_own * (possible - q_own)) / (q_other * (possible - q_other));
    if (!charts_.go_over(x, other + 1, y, rng)) return Proposal::failed(Failure::inverse_failed);
    return {ratio * (y.target / x.target), Failure::none};
}

Proposal ChartGibbs::propose(PssState& x, PssState& y, Rng& rng) const {
    if (!charts_.find_technique(x, rng)) return Proposal::failed(Failure::inverse_failed);
    const std::span<const double> w = charts_.weights(x);
    const auto weight = [&](int i) { return w[i]; };
    const int t = draw_index(x.u.k + 1, 1, weight, rng) + 1;
    if (t == x.u.t) return Proposal::failed(Failure::unchanged);
    if (!charts_.go_over(x, t, y, rng)) return Proposal::failed(Failure::inverse_failed);
    return {1, Failure::none};
}

}  // namespace keyhole
