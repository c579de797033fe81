// The step kernels are symmetric on the torus and stay on it.
#include "pss/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "statistics.h"

namespace keyhole {
namespace {

constexpr double family_level = 1e-4;  // false alarms of this file, by Sidak over its chi-square tests
constexpr int chi_square_tests = 6;

template <class Kernel>
class Kernels : public testing::Test {};
using KernelTypes = testing::Types<KelemenKernel, GaussianKernel>;
TYPED_TEST_SUITE(Kernels, KernelTypes);

// Steps of +d and -d are equally likely: counts of |step| by bins, one histogram for each sign.
TYPED_TEST(Kernels, StepsAreSymmetric) {
    const TypeParam kernel;
    Rng rng(1);
    constexpr int n = 8, bins = 40, rounds = 50000;
    std::vector<double> plus(bins, 0.0), minus(bins, 0.0);
    double x[n], y[n];
    std::fill_n(x, n, 0.5);
    for (int i = 0; i < rounds; ++i) {
        kernel(x, y, n, rng);
        for (int j = 0; j < n; ++j) {
            const double step = y[j] - x[j];
            const int bin = std::min(bins - 1, static_cast<int>(std::abs(step) * 1500));
            ++(step > 0 ? plus : minus)[bin];
        }
    }
    // Given the size, the sign is a fair coin: (plus - minus)^2 / (plus + minus) is chi-square with one degree each.
    double statistic = 0;
    int degrees = 0;
    for (int i = 0; i < bins; ++i) {
        if (plus[i] + minus[i] < 20) continue;
        statistic += sqr(plus[i] - minus[i]) / (plus[i] + minus[i]);
        ++degrees;
    }
    ASSERT_GT(degrees, 10);
    EXPECT_GT(chi_square_tail(statistic, degrees), sidak_level(family_level, chi_square_tests));
}

// Steps from b, each weighted by q(a, y) / q(b, y), fall into bins as steps from a do, where b can reach all of a bin.
TYPED_TEST(Kernels, RatiosOfDensitiesTurnStepsIntoThoseFromAnotherPoint) {
    const TypeParam kernel = TypeParam().scaled(2);
    Rng rng(4);
    constexpr int n = lanes, bins = 1000, rounds = 200000;
    std::vector<double> from_a(bins, 0.0), weighted(bins, 0.0), squares(bins, 0.0);
    const double a = 0.999, b = 0.009;  // the torus' seam lies between them
    double x[n], y[n];
    for (int i = 0; i < rounds; ++i) {
        std::fill_n(x, n, a);
        kernel(x, y, n, rng);
        for (const double u : y) ++from_a[static_cast<std::size_t>(u * bins)];
        std::fill_n(x, n, b);
        kernel(x, y, n, rng);
        for (const double u : y) {
            const double weight = kernel.density_ratio(&a, &b, &u, 1);
            weighted[static_cast<std::size_t>(u * bins)] += weight;
            squares[static_cast<std::size_t>(u * bins)] += weight * weight;
        }
    }
    double statistic = 0;
    int degrees = 0;
    for (int i = 0; i < bins; ++i) {
        bool reached = from_a[i] > 1000;
        for (const double edge : {static_cast<double>(i) / bins, (i + 1.0) / bins, (i + 0.5) / bins})
            reached = reached && kernel.density_ratio(&b, &b, &edge, 1) > 0;
        if (!reached) continue;
        statistic += sqr(from_a[i] - weighted[i]) / (from_a[i] + squares[i]);
        ++degrees;
    }
    ASSERT_GT(degrees, 10);
    EXPECT_GT(chi_square_tail(statistic, degrees), sidak_level(family_level, chi_square_tests));
}

// Coordinates that start uniform stay uniform, also at the seam, and inside [0, 1).
TYPED_TEST(Kernels, KeepTheUniformDistribution) {
    const TypeParam kernel;
    Rng rng(2);
    constexpr int n = 2 * lanes, bins = 50, rounds = 60000;
    std::vector<double> observed(bins, 0.0);
    double x[n], y[n];
    for (int i = 0; i < rounds; ++i) {
        for (double& c : x) c = rng.uniform();
        for (int step = 0; step < 3; ++step) {
            kernel(x, y, n, rng);
            std::copy_n(y, n, x);
        }
        for (const double c : x) {
            ASSERT_GE(c, 0);
            ASSERT_LT(c, 1);
            ++observed[static_cast<int>(c * bins)];
        }
    }
    const std::vector<double> expected(bins, static_cast<double>(n) * rounds / bins);
    EXPECT_GT(chi_square_p_value(expected, observed), sidak_level(family_level, chi_square_tests));
}

TEST(KelemenKernel, StepsLieBetweenItsBounds) {
    const double s1 = 1.0 / 512, s2 = 1.0 / 16;
    const KelemenKernel kernel(s1, s2);
    Rng rng(3);
    double x[lanes] = {0.5, 0.5, 0.5, 0.5}, y[lanes], smallest = 1, largest = 0;
    for (int i = 0; i < 100000; ++i) {
        kernel(x, y, 4, rng);
        for (int j = 0; j < 4; ++j) {
            smallest = std::min(smallest, std::abs(y[j] - x[j]));
            largest = std::max(largest, std::abs(y[j] - x[j]));
        }
    }
    EXPECT_NEAR(smallest, s1, 1e-4 * s1);
    EXPECT_NEAR(largest, s2, 1e-4 * s2);
}

// Steps below what a coordinate can be moved by: no step, or one of the right size, never a wild one.
TEST(KelemenKernel, StaysWithinItsBoundsHoweverSmallTheSmallestStep) {
    for (const double s1 : {1e-30, 1e-45, 1e-300, 5e-324}) {
        const double s2 = 1.0 / 64;
        const KelemenKernel kernel(s1, s2);
        Rng rng(4);
        double x[lanes], y[lanes];
        std::fill_n(x, lanes, 0.5);
        for (int i = 0; i < 10000; ++i) {
            kernel(x, y, lanes, rng);
            for (int j = 0; j < lanes; ++j) ASSERT_LE(std::abs(y[j] - x[j]), s2 * (1 + 1e-5)) << s1;
        }
    }
}

TEST(Exp2Approximate, IsGoodToFourInAMillion) {
    for (float x = 0; x >= -126; x -= 0.001f)
        ASSERT_NEAR(exp2_approximate(Float8{} + x)[0] / std::exp2(static_cast<double>(x)), 1, 4e-6) << x;
}

TEST(WrapUnit, NeverReturnsOne) {
    for (const double x : {-1e-20, -0.0, 0.0, 1.0, -1.0, 1 - 0x1p-53, 2.75, -3.25}) {
        EXPECT_GE(wrap_unit(x), 0);
        EXPECT_LT(wrap_unit(x), 1);
    }
    for (const Double4 x : {Double4{-1e-20, -0.0, 0.0, 1.0}, Double4{-1.0, 1 - 0x1p-53, 1.75, -0.25}}) {
        const Double4 wrapped = wrap_unit(x);
        for (int i = 0; i < 4; ++i) EXPECT_EQ(wrapped[i], wrap_unit(double{x[i]})) << x[i];
    }
    EXPECT_DOUBLE_EQ(wrap_unit(2.75), 0.75);
    EXPECT_DOUBLE_EQ(wrap_unit(-0.25), 0.75);
}

}  // namespace
}  // namespace keyhole
