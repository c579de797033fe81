// P(k, t): how large steps and technique changes choose path length and technique. Fitted to the energies
// E(k, t) = integral of w_t f* that the bootstrap measured, before the first counted mutation.
#pragma once

#include <vector>

namespace keyhole {

struct Technique {
    int k = 0, t = 0;
};

class TechniqueDistribution {
  public:
    // The prior over all techniques of lengths min_length .. max_length (k = 1 has the one technique t = 2): as paths of
    // k edges take a time in proportion to k, P(k) is in proportion to 1 / k and every length gets the same time, shared
    // evenly by its techniques. Short paths carry most light, and light that is seen directly may cover few pixels: with
    // techniques drawn evenly one of thousands, where long paths are allowed, it would be missed.
    TechniqueDistribution(int min_length, int max_length);

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
    bool has_choice(int k) const { return k > 1; }

    // Position in techniques().
    int index(int k, int t) const { return first_[k] + (k == 1 ? 0 : t - 1); }

  private:
    void accumulate();

    std::vector<Technique> techniques_;
    std::vector<int> first_;  // by k; first_[k + 1] ends k's range
    std::vector<double> prior_, p_, cumulative_, length_p_;
};

}  // namespace keyhole
