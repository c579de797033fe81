// P(k, t): how large steps and technique changes choose path length and technique. Fitted to the energies
// E(k, t) = integral of w_t f* that the bootstrap measured, before the first counted mutation.
#pragma once

#include <span>
#include <vector>

#include "pathspace/connect.h"

namespace keyhole {

// The technique t of paths with k edges; {0, 0} stands for all techniques of all lengths at once.
struct Technique {
    int k = 0, t = 0;
};

// One of the indices i < count, drawn in proportion to weight(i) >= 0, which sum to `sum`. -1 if all are zero.
template <class Weight, class Random>
int draw_index(int count, double sum, const Weight& weight, Random& random) {
    double left = random.uniform() * sum;
    int chosen = -1;  // rounding may leave `left` just above zero at the end
    for (int i = 0; i < count; ++i) {
        const double w = weight(i);
        if (!(w > 0)) continue;
        chosen = i;
        if ((left -= w) < 0) break;
    }
    return chosen;
}

class TechniqueDistribution {
  public:
    // The prior over all techniques of lengths min_length .. max_length (k = 1 has the one technique t = 2): as paths
    // of k edges take a time in proportion to k, P(k) is in proportion to 1 / k and every length gets the same time,
    // shared evenly by its techniques. Short paths carry most light, and light that is seen directly may cover few
    // pixels: with techniques drawn evenly one of thousands, where long paths are allowed, it would be missed.
    //
    // Techniques outside of the set have probability zero.
    TechniqueDistribution(int min_length, int max_length, TechniqueSet set = all_techniques);
    // The one technique {0, 0}.
    static TechniqueDistribution all_at_once();

    // In proportion to `energies` (one per techniques()), mixed with a share of the prior so that every technique stays
    // reachable. The prior alone if all energies are zero.
    void fit(const std::vector<double>& energies, double prior_share);

    const std::vector<Technique>& techniques() const { return techniques_; }

    Technique sample(double u) const;
    double probability(int k, int t) const { return p_[index(k, t)]; }

    // Techniques of one length: one in proportion to q(t | k), one other than t, q itself, and whether there is more
    // than one.
    int sample_given_length(int k, double u) const;
    int sample_other(int k, int t, double u) const;
    double probability_given_length(int k, int t) const { return p_[index(k, t)] / length_p_[k]; }
    bool has_choice(int k) const { return choices_[k] > 1; }
    bool has_choice_everywhere() const { return has_choice_everywhere_; }

    // Position in techniques().
    int index(int k, int t) const { return first_[k] + (k == 1 ? 0 : t - 1); }

  private:
    TechniqueDistribution() = default;
    void accumulate();

    std::vector<Technique> techniques_;
    std::vector<int> first_;    // by k; first_[k + 1] ends k's range
    std::vector<int> choices_;  // by k: techniques of the set
    bool has_choice_everywhere_ = true;
    std::vector<double> prior_, p_, cumulative_, length_p_;
};

// q(t | k) of the techniques that can make a path, those with a weight above zero; 0 for the others.
struct PossibleTechniques {
    const TechniqueDistribution& techniques;
    std::span<const double> weights;  // of the path's k + 1 techniques, at t - 1

    int count() const { return static_cast<int>(weights.size()); }
    // At t - 1.
    double operator()(int i) const {
        return weights[i] > 0 ? techniques.probability_given_length(count() - 1, i + 1) : 0;
    }
    double sum() const {
        double sum = 0;
        for (int i = 0; i < count(); ++i) sum += (*this)(i);
        return sum;
    }
};

}  // namespace keyhole
