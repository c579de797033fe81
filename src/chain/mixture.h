// A mixture of strategies: chooses one for each step, and accounts for the choice in the acceptance ratio.
#pragma once

#include <algorithm>
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
        double total = 0;
        for (std::size_t i = 0; i < components_.size(); ++i) {
            const Component& c = components_[i];
            if (!(c.weight >= 0 && std::isfinite(c.weight)))
                throw std::invalid_argument("the weight of a strategy must be finite and not negative");
            total += c.weight;
            if (c.weight > 0) (c.strategy->suitability_varies() ? varying_ : constant_).push_back({c.weight, i});
        }
        if (!(total > 0 && std::isfinite(total)))
            throw std::invalid_argument("the weights of a mixture must have a positive, finite sum");
        // The likely ones first: they are found first.
        std::stable_sort(constant_.begin(), constant_.end(),
                         [](const Entry& a, const Entry& b) { return a.weight > b.weight; });
        for (const Entry& e : constant_) constant_weight_ += e.weight;
    }

    std::size_t size() const { return components_.size(); }
    const Strategy<State, Random>& strategy(std::size_t i) const { return *components_[i].strategy; }
    double weight(std::size_t i) const { return components_[i].weight; }

    Selection select(const State& x, Random& random) const {
        std::array<double, max_size> suited;
        double total = constant_weight_;
        for (std::size_t i = 0; i < varying_.size(); ++i) total += suited[i] = suited_weight(varying_[i], x);
        if (!(total > 0)) return {};
        Selection last;  // rounding may leave `left` just above zero at the end
        double left = random.uniform() * total;
        for (const Entry& e : constant_) {
            last = {e.index, e.weight / total};
            if ((left -= e.weight) < 0) return last;
        }
        for (std::size_t i = 0; i < varying_.size(); ++i) {
            if (suited[i] > 0) last = {varying_[i].index, suited[i] / total};
            if ((left -= suited[i]) < 0) break;
        }
        return last;
    }

    // P(i | x); zero if the strategy does not apply.
    double probability(std::size_t i, const State& x) const {
        const auto [weight, total] = weights(i, x);
        return total > 0 ? weight / total : 0;
    }

    // The ratio of a move to y that `selection` proposed, completed with the probabilities of choosing the strategy.
    double completed_ratio(double ratio, const Selection& selection, const State& y) const {
        if (varying_.empty()) return ratio;
        const auto [weight, total] = weights(selection.index, y);
        return ratio * (total > 0 ? weight / (total * selection.probability) : 0);
    }

  private:
    struct Entry {
        double weight;
        std::size_t index;  // in components_
    };
    struct Weights {
        double chosen, total;
    };

    double suited_weight(const Entry& e, const State& x) const {
        return e.weight * components_[e.index].strategy->suitability(x);
    }
    // Strategy i's weight at x, and the sum of all.
    Weights weights(std::size_t i, const State& x) const {
        Weights w{components_[i].weight, constant_weight_};
        for (const Entry& e : varying_) {
            const double suited = suited_weight(e, x);
            if (e.index == i) w.chosen = suited;
            w.total += suited;
        }
        return w;
    }

    std::vector<Component> components_;
    std::vector<Entry> constant_, varying_;  // those of positive weight, by whether their suitability varies
    double constant_weight_ = 0;
};

}  // namespace keyhole
