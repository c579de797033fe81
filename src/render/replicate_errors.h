// Standard errors of what is developed from a film: of pixels, blocks and the image's mean, from the disagreement of
// independent replicates.
#pragma once

#include <functional>
#include <vector>

#include "chain/normalization.h"
#include "chain/replicates.h"

namespace keyhole {

// An image is P = sum over groups of b / N X, with the group's b, its N mutations and the sum X of their splats. A
// replicate has a part in all three, and they vary together: a replicate that found more light has a larger b and more
// mutations. To first order, a replicate moves P by
//     sum over groups of (X_r - X N_r / N) b / N + (change of b) X / N,
// and b = m / v, of the means of n and l numbers (chain/normalization.h), by
//     ((m_r - m) n_r / (n m) - (v_r - v) l_r / (l v)) b,
// each term with its leverage factor (chain/replicates.h); the sum of the squares is the variance of P. It holds
// whatever is wrong with the chains inside a replicate: correlation, starting points out of equilibrium.
class ReplicateErrors {
  public:
    // By group and replicate.
    ReplicateErrors(const std::vector<std::vector<Normalization>>& b,
                    const std::vector<std::vector<double>>& mutations);

    // False where one replicate has all chains of groups that carry more than a hundredth of b.
    bool known() const { return known_; }

    double b(std::size_t group) const { return b_[group]; }
    // Standard error; infinite where one replicate has all chains of the group.
    double error_of_b(std::size_t group) const { return error_of_b_[group]; }
    double mutations(std::size_t group) const { return mutations_[group]; }

    // `part(group, replicate)`: b / N X_r, of `size` values. Infinite where nothing is known().
    std::vector<double> standard_errors(
        std::size_t size,
        const std::function<std::vector<float>(std::size_t group, std::size_t replicate)>& part) const;

  private:
    std::vector<double> b_, error_of_b_, mutations_;  // by group
    // By group and replicate: a replicate moves P by the sum of own * part(r) + pooled * (sum of all parts).
    struct Factors {
        double own = 0, pooled = 0;
    };
    std::vector<std::vector<Factors>> factors_;
    bool known_ = true;
};

}  // namespace keyhole
