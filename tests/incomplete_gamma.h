// The regularised incomplete gamma functions: tails of the chi-square and of the Poisson distribution.
#pragma once

#include <cmath>
#include <limits>

namespace keyhole {

// P(a, x) and Q(a, x) = 1 - P(a, x) for a > 0, x >= 0, the smaller one of them to 1e-11 relative (for a up to 5000). By
// the power series below x = a + 1, by Lentz's continued fraction above [Abramowitz and Stegun, 6.5.29 and 6.5.31].
struct IncompleteGamma {
    double p, q;

    IncompleteGamma(double a, double x) {
        if (!(x > 0)) {
            p = 0, q = 1;
            return;
        }
        constexpr double epsilon = std::numeric_limits<double>::epsilon(), tiny = 1e-300;
        const double factor = std::exp(a * std::log(x) - x - std::lgamma(a));
        if (x < a + 1) {
            double term = 1 / a, sum = term;
            for (double n = a + 1; term > sum * epsilon; ++n) sum += (term *= x / n);
            p = factor * sum, q = 1 - p;
        } else {
            double b = x + 1 - a, c = 1 / tiny, d = 1 / b, h = d;
            for (double i = 1, delta = 2; std::abs(delta - 1) > 4 * epsilon; ++i) {
                const double numerator = -i * (i - a);
                b += 2;
                d = numerator * d + b;
                d = 1 / (std::abs(d) < tiny ? tiny : d);
                c = b + numerator / c;
                c = std::abs(c) < tiny ? tiny : c;
                h *= delta = d * c;
            }
            q = factor * h, p = 1 - q;
        }
    }
};

// Probability that a chi-square variable exceeds `statistic`.
inline double chi_square_tail(double statistic, double degrees_of_freedom) {
    return IncompleteGamma(degrees_of_freedom / 2, statistic / 2).q;
}

}  // namespace keyhole
