#include "render/replicate_errors.h"

#include <cmath>
#include <limits>

namespace keyhole {
namespace {

constexpr double negligible = 0.01;  // share of b

std::vector<ReplicatePart> parts_of(const std::vector<Normalization>& b, RunningMean Normalization::*mean) {
    std::vector<ReplicatePart> parts;
    for (const Normalization& replicate : b) {
        const double count = static_cast<double>((replicate.*mean).count());
        parts.push_back({(replicate.*mean).mean() * count, count});
    }
    return parts;
}

// How far each replicate moves a mean, relative to it; 0 where nothing is counted.
std::vector<double> relative_deviations(const std::vector<ReplicatePart>& parts) {
    const ReplicatePart all = total(parts);
    std::vector<double> moved = deviations(parts);
    for (double& m : moved) m *= all.count > 0 ? all.count / all.sum : 0;
    return moved;
}

// The same of b. Infinite where one replicate has all that b rests on.
std::vector<double> relative_deviations(const std::vector<Normalization>& b) {
    std::vector<double> moved = relative_deviations(parts_of(b, &Normalization::bridged));
    const std::vector<double> of_visited = relative_deviations(parts_of(b, &Normalization::visited));
    for (std::size_t r = 0; r < moved.size(); ++r)
        moved[r] = std::isinf(of_visited[r]) ? of_visited[r] : moved[r] - of_visited[r];
    return moved;
}

}  // namespace

ReplicateErrors::ReplicateErrors(const std::vector<std::vector<Normalization>>& b,
                                 const std::vector<std::vector<double>>& mutations) {
    const std::size_t groups = b.size();
    double all = 0;
    for (const std::vector<Normalization>& replicates : b) {
        Normalization sum;
        for (const Normalization& replicate : replicates) sum.merge(replicate);
        b_.push_back(sum.b());
        all += b_.back();
    }
    for (std::size_t g = 0; g < groups; ++g) {
        double n = 0;
        for (const double m : mutations[g]) n += m;
        mutations_.push_back(n);
        const std::vector<double> of_b = relative_deviations(b[g]);
        error_of_b_.push_back(b_[g] * std::sqrt(sum_of_squares(of_b)));
        std::vector<ReplicatePart> chains;
        for (const double m : mutations[g]) chains.push_back({0, m});
        const double own = n > 0 ? leverage_factor(chains) : 1;
        std::vector<Factors> factors(mutations[g].size());
        bool known = std::isfinite(own);
        for (std::size_t r = 0; r < factors.size(); ++r) {
            factors[r] = {own, of_b[r] - own * (n > 0 ? mutations[g][r] / n : 0)};
            known = known && std::isfinite(of_b[r]);
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
