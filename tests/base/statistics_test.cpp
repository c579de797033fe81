// The statistics that other tests rely on.
#include "statistics.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace keyhole {
namespace {

TEST(IncompleteGamma, AgreesWithKnownValues) {
    // Closed forms: Q(1/2, x) = erfc(sqrt(x)), Q(1, x) = exp(-x), Q(3, x) = exp(-x) (1 + x + x^2 / 2).
    for (const double x : {1e-6, 0.1, 0.9, 1.4, 1.6, 3.9, 4.1, 10.0, 60.0, 300.0}) {
        EXPECT_NEAR(IncompleteGamma(0.5, x).q / std::erfc(std::sqrt(x)), 1, 1e-12) << x;
        EXPECT_NEAR(IncompleteGamma(1, x).q / std::exp(-x), 1, 1e-12) << x;
        EXPECT_NEAR(IncompleteGamma(3, x).q / (std::exp(-x) * (1 + x + x * x / 2)), 1, 1e-12) << x;
        const IncompleteGamma g(31.5, x);
        EXPECT_NEAR(g.p + g.q, 1, 1e-15) << x;
    }
    EXPECT_EQ(IncompleteGamma(2, 0).p, 0);
    EXPECT_EQ(IncompleteGamma(2, 0).q, 1);
    EXPECT_NEAR(IncompleteGamma(31.5, 50).q, 0.0020772365527847955, 1e-15);
    EXPECT_NEAR(IncompleteGamma(500, 450).p, 0.010717238091289742, 1e-13);
}

TEST(ChiSquare, IsUniformUnderItsNullHypothesis) {
    // P-values of 2000 uniform histograms, put into 10 bins: again a chi-square test. False alarm: 1e-4.
    constexpr int histograms = 2000, draws = 1000;
    const std::vector<double> expected(20, draws / 20.0);
    std::vector<double> p_values(10);
    Rng random(1, 0);
    for (int h = 0; h < histograms; ++h) {
        std::vector<double> observed(20);
        for (int n = 0; n < draws; ++n) ++observed[random.below(20)];
        ++p_values[std::min<std::size_t>(9, static_cast<std::size_t>(10 * chi_square_p_value(expected, observed)))];
    }
    EXPECT_GT(chi_square_p_value(std::vector<double>(10, histograms / 10.0), p_values), 1e-4);
}

}  // namespace
}  // namespace keyhole
