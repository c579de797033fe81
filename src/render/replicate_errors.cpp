#include "render/replicate_errors.h"

#include <cmath>
#include <limits>

namespace keyhole {
namespace {

constexpr double negligible = 0.01;  // share of b

std::vector<ReplicatePart> parts_of(const std::vector<RunningMean>& b) {
    std::vector<ReplicatePart> parts;
    for (const RunningMean& mean : b) {
        const double count = static_cast<double>(mean.count());
        parts.push_back({mean.mean() * count, count});
    }
    return parts;
}

}  // namespace

ReplicateErrors::ReplicateErrors(const std::vector<std::vector<RunningMean>>& b,
                                 const std::vector<std::vector<double>>& mutations) {
    const std::size_t groups = b.size();
    double all = 0;
    for (std::size_t g = 0; g < groups; ++g) {
        const ReplicatePart sum = total(parts_of(b[g]));
        b_.push_back(sum.count > 0 ? sum.sum / sum.count : 0);
        all += b_.back();
    }
    for (std::size_t g = 0; g < groups; ++g) {
        double n = 0;
        for (const double m : mutations[g]) n += m;
        mutations_.push_back(n);
        const std::vector<double> of_b = deviations(parts_of(b[g]));
        std::vector<Factors> factors(mutations[g].size());
        bool known = true;
        for (std::size_t r = 0; r < factors.size(); ++r) {
            const double share = n > 0 ? mutations[g][r] / n : 0, own = leverage_factor(share);
            factors[r] = {own, of_b[r] / b_[g] - own * share};
            known = known && std::isfinite(own) && std::isfinite(of_b[r]);
        }
        if (!known) factors.assign(factors.size(), {});
        if (!known && b_[g] > negligible * all) known_ = false;
        factors_.push_back(std::move(factors));
    }
}

std::vector<double> ReplicateErrors::standard_errors(
    std::size_t size, const std::function<std::vector<float>(std::size_t, std::size_t)>& part) const {
    if (!known_) return std::vector<double>(size, std::numeric_limits<double>::infinity());
    std::vector<std::vector<double>> pooled;
    for (std::size_t g = 0; g < factors_.size(); ++g) {
        pooled.emplace_back(size, 0.0);
        for (std::size_t r = 0; r < factors_[g].size(); ++r) {
            const std::vector<float> own = part(g, r);
            for (std::size_t i = 0; i < size; ++i) pooled[g][i] += own[i];
        }
    }
    std::vector<double> squares(size, 0.0);
    for (std::size_t r = 0; r < factors_[0].size(); ++r) {
        std::vector<double> moved(size, 0.0);
        for (std::size_t g = 0; g < factors_.size(); ++g) {
            const std::vector<float> own = part(g, r);
            for (std::size_t i = 0; i < size; ++i)
                moved[i] += factors_[g][r].own * own[i] + factors_[g][r].pooled * pooled[g][i];
        }
        for (std::size_t i = 0; i < size; ++i) squares[i] += moved[i] * moved[i];
    }
    for (double& s : squares) s = std::sqrt(s);
    return squares;
}

}  // namespace keyhole
