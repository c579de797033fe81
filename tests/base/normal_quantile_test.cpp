#include "base/normal_quantile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/vec.h"

namespace keyhole {
namespace {

// Newton's method on Phi in extended precision, from the value under test.
double reference(double u, double z) {
    long double x = z;
    for (int i = 0; i < 3; ++i) {
        const long double phi = std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi_v<long double>);
        x -= (std::erfc(-x / std::numbers::sqrt2_v<long double>) / 2 - u) / phi;
    }
    return static_cast<double>(x);
}

// AS 241 promises a relative error of 1e-16, plus rounding.
TEST(NormalQuantile, IsAccurateOverItsDomain) {
    for (double u = 1e-16; u < 0.5; u *= 1.03) {
        const double z = normal_quantile(u);
        EXPECT_NEAR(z / reference(u, z), 1, 2e-15) << u;
    }
    EXPECT_EQ(normal_quantile(0.5), 0);
}

TEST(NormalQuantile, IsOddAboutOneHalf) {
    for (double u = 1.0 / 1024; u < 0.5; u += 1.0 / 1024) EXPECT_EQ(normal_quantile(u), -normal_quantile(1 - u)) << u;
}

TEST(NormalQuantile, EndsAreFinite) {
    EXPECT_NEAR(normal_quantile(0), -8.2, 0.1);
    EXPECT_NEAR(normal_quantile(one_minus_epsilon), 8.2, 0.1);
}

TEST(NormalCdf, InvertsTheQuantile) {
    // A relative error of 6e-16 in z is z^2 as much in the tail's probability, and |z| < 8.3.
    for (double u = 1e-15; u < 1; u = u * 1.03 + 1e-4 * u * (1 - u))
        EXPECT_NEAR(normal_cdf(normal_quantile(u)) / u, 1, 5e-14) << u;
}

}  // namespace
}  // namespace keyhole
