#include "strategies/inverse_small_step.h"

namespace keyhole {

template <class Kernel>
Proposal InverseSmallStep<Kernel>::propose(PssState& x, PssState& y, Rng& rng) const {
    const int k = x.u.k;
    const PossibleTechniques q{techniques_, charts_.weights(x)};
    const double q_x = q.sum();
    const int i = draw_index(q.count(), q_x, q, rng), t = i + 1;
    const double w_x = q.weights[i];
    if (!charts_.invert(x, t, u_, rng)) return Proposal::failed(Failure::inverse_failed);
    y.u.k = k;
    y.u.t = t;
    kernel_(u_.data(), y.u.data(), charts_.layout().count(k, t), rng);
    if (const PathFailure failure = charts_.evaluate(y); failure != PathFailure::none)
        return Proposal::failed(to_failure(failure));
    if (!charts_.invert(y, t, u_, rng)) return Proposal::failed(Failure::inverse_failed);
    const double w_y = y.path.weight, q_y = PossibleTechniques{techniques_, charts_.weights(y)}.sum();
    y.known = Known::path;
    return {(y.target / w_y) / (x.target / w_x) * (q_x / q_y), Failure::none};
}

template class InverseSmallStep<KelemenKernel>;
template class InverseSmallStep<GaussianKernel>;

}  // namespace keyhole
