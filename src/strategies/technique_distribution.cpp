#include "strategies/technique_distribution.h"

#include <algorithm>
#include <numeric>

namespace keyhole {

TechniqueDistribution::TechniqueDistribution(int min_length, int max_length, TechniqueSet set)
    : first_(max_length + 2, 0), choices_(max_length + 1, 0) {
    const auto in_set = [&](const Technique& technique) { return set.holds(technique.k + 1 - technique.t); };
    double lengths = 0;
    for (int k = min_length; k <= max_length; ++k) {
        first_[k] = static_cast<int>(techniques_.size());
        for (int t = k == 1 ? 2 : 1; t <= (k == 1 ? 2 : k + 1); ++t) {
            techniques_.push_back({k, t});
            choices_[k] += in_set({k, t});
        }
        if (choices_[k] > 0) lengths += 1.0 / k;
        if (choices_[k] == 1) has_choice_everywhere_ = false;
    }
    first_[max_length + 1] = static_cast<int>(techniques_.size());
    for (const Technique& technique : techniques_)
        prior_.push_back(in_set(technique) ? 1 / (lengths * technique.k * choices_[technique.k]) : 0);
    p_ = prior_;
    length_p_.assign(max_length + 1, 0.0);
    accumulate();
}

TechniqueDistribution TechniqueDistribution::all_at_once() {
    TechniqueDistribution one;
    one.techniques_ = {{0, 0}};
    one.first_ = {1, 1};  // index(0, 0) is 0
    one.choices_ = {1};
    one.has_choice_everywhere_ = false;
    one.prior_ = one.p_ = {1};
    one.length_p_ = {1};
    one.accumulate();
    return one;
}

void TechniqueDistribution::fit(const std::vector<double>& energies, double prior_share) {
    const double sum = std::accumulate(energies.begin(), energies.end(), 0.0);
    for (std::size_t i = 0; i < p_.size(); ++i)
        p_[i] = sum > 0 ? (1 - prior_share) * energies[i] / sum + prior_share * prior_[i] : prior_[i];
    accumulate();
}

void TechniqueDistribution::accumulate() {
    cumulative_.assign(p_.size() + 1, 0.0);
    std::partial_sum(p_.begin(), p_.end(), cumulative_.begin() + 1);
    std::fill(length_p_.begin(), length_p_.end(), 0.0);
    for (std::size_t i = 0; i < p_.size(); ++i) length_p_[techniques_[i].k] += p_[i];
}

Technique TechniqueDistribution::sample(double u) const {
    const auto begin = cumulative_.begin() + 1, end = cumulative_.end() - 1;
    return techniques_[std::upper_bound(begin, end, u * cumulative_.back()) - begin];
}

int TechniqueDistribution::sample_given_length(int k, double u) const {
    const auto begin = cumulative_.begin() + first_[k], end = cumulative_.begin() + first_[k + 1];
    const double value = *begin + u * (*end - *begin);
    return techniques_[std::upper_bound(begin + 1, end, value) - cumulative_.begin() - 1].t;
}

int TechniqueDistribution::sample_other(int k, int t, double u) const {
    double left = u * (length_p_[k] - probability(k, t));
    int chosen = 0;
    for (int other = 1; other <= k + 1; ++other) {
        const double p = probability(k, other);
        if (other == t || !(p > 0)) continue;
        chosen = other;
        left -= p;
        if (left < 0) break;
    }
    return chosen;
}

}  // namespace keyhole
