// The statistics that other tests rely on.
#include "statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "base/vec.h"

namespace keyhole {
namespace {

TEST(Tails, AgreeWithClosedForms) {
    for (const double x : {1e-6, 0.1, 0.9, 3.9, 60.0, 300.0}) {
        EXPECT_NEAR(chi_square_tail(2 * x, 2) / std::exp(-x), 1, 1e-12) << x;
        EXPECT_NEAR(chi_square_tail(2 * x, 1) / std::erfc(std::sqrt(x)), 1, 1e-12) << x;
        EXPECT_NEAR(student_two_sided_tail(x, 1), 1 - 2 / pi * std::atan(x), 1e-12) << x;
    }
    EXPECT_EQ(chi_square_tail(0, 3), 1);
    EXPECT_NEAR(normal_two_sided_quantile(0.05), 1.959963984540054, 1e-12);
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
