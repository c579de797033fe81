#include "strategies/chart_exchange.h"

namespace keyhole {

Proposal ChartExchange::propose(PssState& a, PssState& b, PssState& new_a, PssState& new_b, Rng& rng) const {
    const auto ratio = [&](const PssState& x, int to, int from) {
        const std::span<const double> w = charts_.weights(x);
        return w[to - 1] / w[from - 1];
    };
    const double r = ratio(a, b.u.t, a.u.t) * ratio(b, a.u.t, b.u.t);
    if (!(r > 0)) return Proposal::failed(Failure::outside_support);
    if (!charts_.go_over(a, b.u.t, new_b, rng) || !charts_.go_over(b, a.u.t, new_a, rng))
        return Proposal::failed(Failure::inverse_failed);
    return {r, Failure::none};
}

}  // namespace keyhole
