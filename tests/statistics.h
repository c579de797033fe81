// Statistics shared by the tests: p-values, and the level they are held against.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/vec.h"

#include "incomplete_gamma.h"

namespace keyhole {

// Level of one of `tests` tests such that all of them together raise a false alarm with probability `family_level`
// (Sidak; exact for independent tests).
inline double sidak_level(double family_level, int tests) { return -std::expm1(std::log1p(-family_level) / tests); }

// Pearson's chi-square of observed counts against expected ones (same totals). Cells that expect fewer than five are
// pooled into one; should the pool itself expect fewer, it is tested by the Poisson tail and the two p-values are
// combined (Bonferroni). A sample where nothing is expected gives 0.
inline double chi_square_p_value(const std::vector<double>& expected, const std::vector<double>& observed) {
    double statistic = 0, pool_expected = 0, pool_observed = 0;
    int cells = 0;
    const auto add = [&](double e, double o) {
        statistic += (o - e) * (o - e) / e;
        ++cells;
    };
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] >= 5) {
            add(expected[i], observed[i]);
        } else {
            pool_expected += expected[i];
            pool_observed += observed[i];
        }
    }
    if (pool_expected == 0 && pool_observed > 0) return 0;
    if (pool_expected >= 5) add(pool_expected, pool_observed);
    const bool small_pool = pool_expected > 0 && pool_expected < 5;
    const double pool_p = small_pool && pool_observed > 0 ? IncompleteGamma(pool_observed, pool_expected).p : 1;
    if (cells < 2) return pool_p;
    const double p = chi_square_tail(statistic, cells - 1);
    return small_pool ? std::min(1.0, 2 * std::min(p, pool_p)) : p;
}

// P(|T| > |t|) of Student's distribution with a whole number of degrees of freedom, by its finite series [Abramowitz and
// Stegun 26.7.3 and 26.7.4].
inline double student_two_sided_tail(double t, int degrees) {
    const double angle = std::atan(std::abs(t) / std::sqrt(degrees)), c = std::cos(angle), s = std::sin(angle);
    const bool odd = degrees % 2 == 1;
    double term = odd ? c : 1, sum = degrees == 1 ? 0 : term;
    for (int i = odd ? 3 : 2; i <= degrees - 2; i += 2) {
        term *= c * c * (i - 1) / i;
        sum += term;
    }
    const double inside = odd ? (angle + s * sum) * 2 / pi : s * sum;
    return std::max(0.0, 1 - inside);
}

}  // namespace keyhole
