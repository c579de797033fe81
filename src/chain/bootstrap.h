// Starting chains in proportion to the target, from independent weighted samples [Veach 1997, section 11.3.1].
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

namespace keyhole {

// Systematic resampling: `count` indices in ascending order. Index i occurs floor(e) or ceil(e) times and on average e
// times, where e = count * weights[i] / sum of weights, given `u` uniform in [0, 1).
//
// Throws std::invalid_argument if a weight is negative or not finite, or if all are zero.
inline std::vector<std::size_t> resample(std::span<const double> weights, std::size_t count, double u) {
    double total = 0;
    for (const double w : weights) {
        if (!(w >= 0 && std::isfinite(w))) throw std::invalid_argument("a resampling weight is negative or not finite");
        total += w;
    }
    if (!(total > 0 && std::isfinite(total)))
        throw std::invalid_argument("the resampling weights have no positive sum");

    std::vector<std::size_t> indices;
    indices.reserve(count);
    double cumulative = 0;
    std::size_t last = 0;  // the last index of positive weight: takes what rounding leaves at the end
    for (std::size_t i = 0; i < weights.size() && indices.size() < count; ++i) {
        if (!(weights[i] > 0)) continue;
        last = i;
        cumulative += weights[i];
        const double reached = cumulative / total * static_cast<double>(count);
        while (indices.size() < count && static_cast<double>(indices.size()) + u < reached) indices.push_back(i);
    }
    indices.resize(count, last);
    return indices;
}

// The weights, of which the largest are cut to the level at which none is more than the share `most` of their sum.
// Where fewer than 1 / most are above zero, these become equal. As they are with most = 1.
inline std::vector<double> bounded_shares(std::span<const double> weights, double most) {
    std::vector<double> sorted;
    for (const double w : weights)
        if (w > 0) sorted.push_back(w);
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    std::vector<double> rest(sorted.size() + 1);  // sums without the m largest, exact to rounding whatever those are
    for (std::size_t m = sorted.size(); m-- > 0;) rest[m] = rest[m + 1] + sorted[m];
    double level = sorted.empty() ? 0 : sorted.back();
    // With the m largest at the level c, c = most (m c + rest).
    for (std::size_t m = 0; m < sorted.size() && static_cast<double>(m) * most < 1; ++m) {
        const double c = most * rest[m] / (1 - static_cast<double>(m) * most);
        if (sorted[m] > c) continue;
        level = c;
        break;
    }
    std::vector<double> bounded(weights.begin(), weights.end());
    for (double& w : bounded) w = std::min(w, level);
    return bounded;
}

// Total variation distance of two sets of shares, in [0, 1]: how much of the one is elsewhere in the other. Neither has
// to be normalised; 0 if all of one are zero.
inline double moved_share(std::span<const double> from, std::span<const double> to) {
    const double a = std::accumulate(from.begin(), from.end(), 0.0), b = std::accumulate(to.begin(), to.end(), 0.0);
    double moved = 0;
    for (std::size_t i = 0; i < from.size() && a > 0 && b > 0; ++i) moved += std::abs(from[i] / a - to[i] / b) / 2;
    return moved;
}

}  // namespace keyhole
