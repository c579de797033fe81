// A mixture of strategies: chooses one for each step, and accounts for the choice in the acceptance ratio.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "chain/strategy.h"

namespace keyhole {

// Strategy i is chosen at state x with P(i | x) = weight_i suitability_i(x) / sum_j weight_j suitability_j(x).
//
// Choosing i at x and then moving from x to y with i's kernel is balanced by the reverse move only if that chooses i
// at y, so the ratio of strategy i is completed with P(i | y) / P(i | x) [Veach 1997, section 11.3.1]. This is the only
// place where selection probabilities are known.
template <class State, RandomSource Random>
class Mixture {
  public:
    static constexpr std::size_t max_size = 32;

    struct Component {
        std::unique_ptr<const Strategy<State, Random>> strategy;
        double weight = 1;  // relative to the other weights
    };

    // A strategy chosen at a state; `index` is meaningless if `probability` is zero: no strategy applies.
    struct Selection {
        std::size_t index = 0;
        double probability = 0;  // P(index | state)
    };

    // Throws std::invalid_argument unless there are 1 to max_size strategies with finite weights >= 0, one of them > 0.
    explicit Mixture(std::vector<Component> components) : components_(std::move(components)) {
        if (components_.empty() || components_.size() > max_size)
            throw std::invalid_argument("a mixture has 1 to " + std::to_string(max_size) + " strategies");
        for (const Component& c : components_) {
            if (!(c.weight >= 0 && std::isfinite(c.weight)))
                throw std::invalid_argument("the weight of a strategy must be finite and not negative");
            total_weight_ += c.weight;
            varying_.push_back(c.strategy->suitability_varies());
            varies_ = varies_ || varying_.back();
        }
        if (!(total_weight_ > 0 && std::isfinite(total_weight_)))
            throw std::invalid_argument("the weights of a mixture must have a positive, finite sum");
    }

    std::size_t size() const { return components_.size(); }
    const Strategy<State, Random>& strategy(std::size_t i) const { return *components_[i].strategy; }
    double weight(std::size_t i) const { return components_[i].weight; }

    Selection select(const State& x, Random& random) const {
        std::array<double, max_size> weights;
        const double total = varies_ ? suited_weights(x, weights) : total_weight_;
        if (!(total > 0)) return {};
        double left = random.uniform() * total;
        std::size_t chosen = 0;
        double chosen_weight = 0;
        for (std::size_t i = 0; i < components_.size(); ++i) {
            const double w = varies_ ? weights[i] : components_[i].weight;
            if (w > 0) chosen = i, chosen_weight = w;  // rounding may leave `left` just above zero at the end
            left -= w;
            if (left < 0) break;
        }
        return {chosen, chosen_weight / total};
    }

    // P(i | x); zero if the strategy does not apply.
    double probability(std::size_t i, const State& x) const {
        if (!varies_) return components_[i].weight / total_weight_;
        std::array<double, max_size> weights;
        const double total = suited_weights(x, weights);
        return total > 0 ? weights[i] / total : 0;
    }

    // The ratio of a move to y that `selection` proposed, completed with the probabilities of choosing the strategy.
    double completed_ratio(double ratio, const Selection& selection, const State& y) const {
        if (!varies_) return ratio;
        std::array<double, max_size> weights;
        const double total = suited_weights(y, weights);
        return ratio * (total > 0 ? weights[selection.index] / (total * selection.probability) : 0);
    }

  private:
    double suited_weights(const State& x, std::array<double, max_size>& weights) const {
        double total = 0;
        for (std::size_t i = 0; i < components_.size(); ++i) {
            weights[i] = components_[i].weight;
            if (varying_[i]) weights[i] *= components_[i].strategy->suitability(x);
            total += weights[i];
        }
        return total;
    }

    std::vector<Component> components_;
    std::vector<char> varying_;  // whether the suitability of each one varies
    double total_weight_ = 0;
    bool varies_ = false;
};

}  // namespace keyhole
