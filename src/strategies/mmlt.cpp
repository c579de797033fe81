#include "strategies/mmlt.h"

#include <algorithm>

namespace keyhole {
namespace {

void draw_uniform(double* u, int n, Rng& rng) {
    for (int i = 0; i < n; ++i) u[i] = rng.uniform();
}

// The first `n` coordinates of y, of which x has `old_n`: kept as far as x has them, the rest drawn.
void keep_or_draw(const double* x, int old_n, double* y, int n, Rng& rng) {
    const int kept = std::min(old_n, n);
    std::copy_n(x, kept, y);
    draw_uniform(y + kept, n - kept, rng);
}

// A move from coordinates of x to coordinates of y.
bool start_move(Evaluator& evaluator, PssState& x, Rng& rng) {
    return evaluator.find_coordinates(x, rng) && evaluator.may_move_in_chart(x, rng);
}
// y's coordinates are a symmetric step from those of x, which may be y itself.
template <class Kernel>
void step(Evaluator& evaluator, const Kernel& kernel, const PssState& x, PssState& y, Rng& rng) {
    y.u.k = x.u.k;
    y.u.t = x.u.t;
    kernel(x.u.data(), y.u.data(), evaluator.layout().count(x.u.k, x.u.t), rng);
}
// Evaluates y at its coordinates; the proposal's ratio is C(y) / C(x) times `factor`.
Proposal finish_move(Evaluator& evaluator, const PssState& x, PssState& y, double factor, Rng& rng) {
    const PathFailure failure = evaluator.evaluate(y);
    if (failure != PathFailure::none) return Proposal::failed(to_failure(failure));
    if (!evaluator.may_move_in_chart(y, rng)) return Proposal::failed(Failure::inverse_failed);
    return {y.target / x.target * factor, Failure::none};
}

}  // namespace

Failure to_failure(PathFailure failure) {
    switch (failure) {
        case PathFailure::none:
            return Failure::none;
        case PathFailure::eye_subpath_short:
            return Failure::eye_subpath_short;
        case PathFailure::light_subpath_short:
            return Failure::light_subpath_short;
        case PathFailure::occluded:
            return Failure::occluded;
        case PathFailure::zero_bsdf:
            return Failure::zero_bsdf;
        case PathFailure::outside_film:
            return Failure::outside_film;
        case PathFailure::non_finite:
            return Failure::non_finite;
    }
    return Failure::other;
}

PathFailure LargeStep::draw(PssState& y, Rng& rng) const { return draw(y, techniques_.sample(rng.uniform()), rng); }

PathFailure LargeStep::draw(PssState& y, Technique technique, Rng& rng) const {
    y.u.k = technique.k;
    y.u.t = technique.t;
    draw_uniform(y.u.data(), evaluator_.layout().count(y.u.k, y.u.t), rng);
    return evaluator_.evaluate(y);
}

Proposal LargeStep::propose(PssState& x, PssState& y, Rng& rng) const {
    if (!evaluator_.find_technique(x, rng)) return Proposal::failed(Failure::inverse_failed);
    const int k = x.u.k;
    const PathFailure failure =
        fixed_length_ ? draw(y, {k, techniques_.sample_given_length(k, rng.uniform())}, rng) : draw(y, rng);
    if (failure == PathFailure::none) return {estimate(y) / estimate(x)};
    if (rectification_.policy != Rectification::retry || !start_move(evaluator_, x, rng))
        return Proposal::failed(to_failure(failure));
    step(evaluator_, KelemenKernel(), x, y, rng);
    return retried(to_failure(failure), finish_move(evaluator_, x, y, 1, rng), 1);
}

template <class Kernel>
Proposal SmallStep<Kernel>::propose(PssState& x, PssState& y, Rng& rng) const {
    if (!start_move(evaluator_, x, rng)) return Proposal::failed(Failure::inverse_failed);
    step(evaluator_, kernel_, x, y, rng);
    const Proposal first = finish_move(evaluator_, x, y, 1, rng);
    if (first.failure == Failure::none) return first;
    switch (rectification_.policy) {
        case Rectification::walk_on:
            return walk_on(first, rectification_.walk_steps, [&] {
                step(evaluator_, kernel_, y, y, rng);
                return finish_move(evaluator_, x, y, 1, rng);
            });
        case Rectification::retry:
            return retry(first.failure, x, y, rng);
        case Rectification::off:
        case Rectification::exclude:
            break;
    }
    return first;
}

template <class Kernel>
Proposal SmallStep<Kernel>::retry(Failure failure, PssState& x, PssState& y, Rng& rng) const {
    const int n = evaluator_.layout().count(x.u.k, x.u.t);
    std::copy_n(y.u.data(), n, failed_.data());
    step(evaluator_, second_, x, y, rng);
    const double densities = kernel_.density_ratio(y.u.data(), x.u.data(), failed_.data(), n);
    // Not traced in vain.
    if (!(densities > 0)) return retried(failure, Proposal::failed(Failure::outside_support), 1);
    return retried(failure, finish_move(evaluator_, x, y, 1, rng), densities);
}

Proposal TechniqueChange::propose(PssState& x, PssState& y, Rng& rng) const {
    if (!start_move(evaluator_, x, rng)) return Proposal::failed(Failure::inverse_failed);
    const int k = x.u.k, t = x.u.t;
    y.u.k = k;
    y.u.t = techniques_.sample_other(k, t, rng.uniform());
    const CoordinateLayout& layout = evaluator_.layout();
    const int eye_old = layout.eye_count(t), eye_new = layout.eye_count(y.u.t);
    keep_or_draw(x.u.data(), eye_old, y.u.data(), eye_new, rng);
    keep_or_draw(x.u.data() + eye_old, layout.light_count(x.u.s()),  //
                 y.u.data() + eye_new, layout.light_count(y.u.s()), rng);
    return finish_move(evaluator_, x, y, ratio_of_choices(k, t, y.u.t), rng);
}

template class SmallStep<KelemenKernel>;
template class SmallStep<GaussianKernel>;

}  // namespace keyhole
