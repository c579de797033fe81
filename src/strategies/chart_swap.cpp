#include "strategies/chart_swap.h"

namespace keyhole {

Proposal ChartSwap::propose(PssState& x, PssState& y, Rng& rng) const {
    if (!charts_.find_technique(x, rng)) return Proposal::failed(Failure::inverse_failed);
    const int k = x.u.k, t = x.u.t;
    const std::span<const double> w = charts_.weights(x);
    const auto q = [&](int i) { return w[i] > 0 ? techniques_.probability_given_length(k, i + 1) : 0; };
    double possible = 0;
    for (int i = 0; i <= k; ++i) possible += q(i);
    const double q_own = q(t - 1);
    const auto q_other = [&](int i) { return i == t - 1 ? 0 : q(i); };
    const int other = draw_index(k + 1, possible - q_own, q_other, rng) + 1;
    if (other == 0) return Proposal::failed(Failure::unchanged);
    const double q_chosen = q(other - 1);
    const double ratio = w[other - 1] / w[t - 1] * (q_own * (possible - q_own)) / (q_chosen * (possible - q_chosen));
    if (!charts_.go_over(x, other, y, rng)) return Proposal::failed(Failure::inverse_failed);
    return {ratio * (y.target / x.target), Failure::none};
}

Proposal ChartGibbs::propose(PssState& x, PssState& y, Rng& rng) const {
    if (!charts_.find_technique(x, rng)) return Proposal::failed(Failure::inverse_failed);
    const std::span<const double> w = charts_.weights(x);
    const int t = draw_index(
                      x.u.k + 1, 1, [&](int i) { return w[i]; }, rng) +
                  1;
    if (t == x.u.t) return Proposal::failed(Failure::unchanged);
    if (!charts_.go_over(x, t, y, rng)) return Proposal::failed(Failure::inverse_failed);
    return {1, Failure::none};
}

}  // namespace keyhole
