#include "strategies/inverse_small_step.h"

namespace keyhole {

template <class Kernel>
double InverseSmallStep<Kernel>::possible(int k, std::span<const double> weights) const {
    double sum = 0;
    for (int t = 1; t <= k + 1; ++t)
        if (weights[t - 1] > 0) sum += techniques_.probability_given_length(k, t);
    return sum;
}

template <class Kernel>
Proposal InverseSmallStep<Kernel>::propose(PssState& x, PssState& y, Rng& rng) const {
    const int k = x.u.k;
    const std::span<const double> w = charts_.weights(x);
    const double q_x = possible(k, w);
    const int t =
        draw_index(
            k + 1, q_x, [&](int i) { return w[i] > 0 ? techniques_.probability_given_length(k, i + 1) : 0; }, rng) +
        1;
    const double w_x = w[t - 1];
    if (!charts_.invert(x, t, u_, rng)) return Proposal::failed(Failure::inverse_failed);
    y.u.k = k;
    y.u.t = t;
    kernel_(u_.data(), y.u.data(), charts_.layout().count(k, t), rng);
    if (const PathFailure failure = charts_.evaluate(y); failure != PathFailure::none)
        return Proposal::failed(to_failure(failure));
    if (!charts_.invert(y, t, u_, rng)) return Proposal::failed(Failure::inverse_failed);
    const double w_y = y.path.weight, q_y = possible(k, charts_.weights(y));
    y.known = Known::path;
    return {(y.target / w_y) / (x.target / w_x) * (q_x / q_y), Failure::none};
}

template class InverseSmallStep<KelemenKernel>;
template class InverseSmallStep<GaussianKernel>;

}  // namespace keyhole
