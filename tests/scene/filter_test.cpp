// Reconstruction filters.
#include "scene/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace keyhole {
namespace {

// Midpoint rule; its error is below 1e-6 at this step (kinks and jumps lie on the grid).
double integral(const ReconstructionFilter& filter) {
    const int n = 4096;
    const double step = 2 * filter.radius / n;
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += filter(-filter.radius + (i + 0.5) * step) * step;
    return sum;
}

class FilterTest : public testing::TestWithParam<ReconstructionFilter> {};

TEST_P(FilterTest, HasUnitIntegral) { EXPECT_NEAR(integral(GetParam()), 1, 1e-6); }

TEST_P(FilterTest, IsEvenAndVanishesOutsideItsRadius) {
    const ReconstructionFilter& filter = GetParam();
    for (int i = 0; i < 300; ++i) {
        const double x = 0.01 * i;
        EXPECT_EQ(filter(x), filter(-x));
        EXPECT_GE(filter(x), 0);
        EXPECT_TRUE(x <= filter.radius || filter(x) == 0);
    }
    EXPECT_GT(filter(0.999 * filter.radius), 0);
}

INSTANTIATE_TEST_SUITE_P(All, FilterTest,
                         testing::Values(make_box_filter(), make_box_filter(1.25), make_tent_filter(),
                                         make_tent_filter(0.7), make_gaussian_filter(), make_gaussian_filter(0.4, 1)));

TEST(Filter, BoxAndTentOfWholeRadiusArePartitionsOfUnity) {
    for (const auto& filter : {make_box_filter(), make_tent_filter()})
        for (int i = 0; i < 100; ++i) {
            const double x = 0.003 + 0.01 * i;
            double sum = 0;
            for (int pixel = -3; pixel <= 3; ++pixel) sum += filter(x - (pixel + 0.5));
            EXPECT_NEAR(sum, 1, 1e-14) << filter.name() << " at " << x;
        }
}

// Ratios of values do not depend on the normalisation: Mitsuba's bell exp(-x^2 / 2 s^2) - exp(-r^2 / 2 s^2).
TEST(Filter, GaussianHasMitsubasShape) {
    const auto filter = make_gaussian_filter();
    const auto bell = [](double x) { return std::exp(-2 * x * x) - std::exp(-8.0); };
    for (const double x : {0.25, 0.5, 1.0, 1.75}) EXPECT_NEAR(filter(x) / filter(0), bell(x) / bell(0), 1e-14);
    EXPECT_EQ(filter(2), 0);
}

TEST(Filter, RefusesSizesThatAreNotPositive) {
    EXPECT_THROW(make_box_filter(0), std::invalid_argument);
    EXPECT_THROW(make_tent_filter(-1), std::invalid_argument);
    EXPECT_THROW(make_gaussian_filter(0, 2), std::invalid_argument);
    EXPECT_THROW(make_gaussian_filter(0.5, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace keyhole
