// Multiplexed Metropolis light transport [Hachisuka et al. 2014]: primary-sample-space moves within and between the
// charts of bidirectional techniques. Derivations of the ratios: theory, section 3.
#pragma once

#include "base/rng.h"
#include "chain/rectification.h"
#include "chain/strategy.h"
#include "pss/kernels.h"
#include "strategies/evaluator.h"
#include "strategies/technique_distribution.h"

namespace keyhole {

using PssStrategy = Strategy<PssState, Rng>;

Failure to_failure(PathFailure failure);

// k, t ~ P(k, t) and u uniform. The density of the proposal is P(k, t), so
//     r = [C(y) / P(k_y, t_y)] / [C(x) / P(k_x, t_x)].
// Every proposal is also an independent estimate of b: C(y) / P(k_y, t_y), 0 if it failed.
//
// With Rectification::retry a small step about x follows one that fails: r = C(y) / C(x), since the density of the
// failed point is the same from x and from y.
//
// Where a chain keeps its length k, t ~ P(t | k), which stands in place of P(k, t) in the ratio and in the estimate;
// that is then one of b_k, the part of b that paths of length k carry.
class LargeStep final : public PssStrategy {
  public:
    LargeStep(Evaluator& evaluator, const TechniqueDistribution& techniques, bool fixed_length = false,
              const RectificationSettings& rectification = {})
        : evaluator_(evaluator), techniques_(techniques), fixed_length_(fixed_length), rectification_(rectification) {}
    std::string_view name() const override { return "large-step"; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

    // Draws an independent state, of any length, as the bootstrap does as well.
    PathFailure draw(PssState& y, Rng& rng) const;
    // The estimate of b, or of b_k with k = y.u.k, that a state so drawn is.
    double estimate(const PssState& y) const {
        return y.target / (fixed_length_ ? techniques_.probability_given_length(y.u.k, y.u.t)
                                         : techniques_.probability(y.u.k, y.u.t));
    }

  private:
    PathFailure draw(PssState& y, Technique technique, Rng& rng) const;

    Evaluator& evaluator_;
    const TechniqueDistribution& techniques_;
    bool fixed_length_;
    RectificationSettings rectification_;
};

// u' = u + symmetric step in the current chart, wrapped: r = C(y) / C(x). What follows a step that fails is the
// rectification's.
template <class Kernel>
class SmallStep final : public PssStrategy {
  public:
    SmallStep(Evaluator& evaluator, const Kernel& kernel, const RectificationSettings& rectification = {})
        : evaluator_(evaluator),
          kernel_(kernel),
          second_(kernel.scaled(rectification.retry_scale)),
          rectification_(rectification),
          failed_(evaluator.make_state().u) {}
    std::string_view name() const override { return "small-step"; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;

  private:
    Proposal retry(Failure failure, PssState& x, PssState& y, Rng& rng) const;

    Evaluator& evaluator_;
    Kernel kernel_, second_;
    RectificationSettings rectification_;
    mutable PrimarySample failed_;  // a strategy belongs to one thread
};

// What moves to another technique t' != t of the same length have in common: t' is drawn in proportion to q(t' | k).
class ToOtherTechnique : public PssStrategy {
  public:
    ToOtherTechnique(Evaluator& evaluator, const TechniqueDistribution& techniques)
        : evaluator_(evaluator), techniques_(techniques) {}
    double suitability(const PssState& x) const final { return techniques_.has_choice(x.u.k) ? 1 : 0; }
    bool suitability_varies() const final { return !techniques_.has_choice_everywhere(); }

  protected:
    // What the choice contributes to the ratio: [q(t | k) / (1 - q(t' | k))] / [q(t' | k) / (1 - q(t | k))].
    double ratio_of_choices(int k, int t, int other) const {
        const double q = techniques_.probability_given_length(k, t);
        const double q_other = techniques_.probability_given_length(k, other);
        return q * (1 - q) / (q_other * (1 - q_other));
    }

    Evaluator& evaluator_;
    const TechniqueDistribution& techniques_;
};

// Same k and same u, another technique: a different path. Coordinates that the chart t' reads and t does not are drawn
// fresh, and their densities (one) cancel against those forgotten on the way back:
//     r = [C(y) / C(x)] times the ratio of the choices.
class TechniqueChange final : public ToOtherTechnique {
  public:
    using ToOtherTechnique::ToOtherTechnique;
    std::string_view name() const override { return "technique-change"; }
    Proposal propose(PssState& x, PssState& y, Rng& rng) const override;
};

extern template class SmallStep<KelemenKernel>;
extern template class SmallStep<GaussianKernel>;

}  // namespace keyhole
