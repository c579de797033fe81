#include "compare/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "base/rng.h"
#include "base/vec.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

Image from_values(int width, int height, const std::vector<float>& values) {
    Image image(width, height);
    image.rgb = values;
    return image;
}

Image constant(int width, int height, float value) {
    Image image(width, height);
    std::fill(image.rgb.begin(), image.rgb.end(), value);
    return image;
}

// Sums of doubles over few values: rounding is far below this.
constexpr double rounding = 1e-13;

// Two pixels, computed by hand. R = (1 2 1 | 0 2 0), I = (2 2 0 | 0 1 1); differences 1 0 1 | 0 1 1; mean(R) = 1.
TEST(Metrics, MatchHandComputedValues) {
    const Image image = from_values(2, 1, {2, 2, 0, 0, 1, 1});
    const Image reference = from_values(2, 1, {1, 2, 1, 0, 2, 0});
    const ErrorMetrics m = compare_images(image, reference);
    EXPECT_EQ(m.pixels, 2u);
    EXPECT_EQ(m.masked, 0u);
    EXPECT_EQ(m.non_finite, 0u);
    EXPECT_NEAR(m.mse, 4.0 / 6, rounding);
    EXPECT_NEAR(m.rmse, std::sqrt(4.0 / 6), rounding);
    const double relative = (1 / 1.001 + 0 + 1 / 1.001 + 0 + 1 / 4.001 + 1 / 0.001) / 6;
    EXPECT_NEAR(m.rrmse, std::sqrt(relative), rounding);
    EXPECT_NEAR(m.relmse_trimmed, relative, 1e3 * rounding);  // 0.1% of two pixels is none; the value is above 100
    const double mape = 2 / std::sqrt(1.001) + 1 / std::sqrt(4.001) + 1 / std::sqrt(0.001);
    EXPECT_NEAR(m.mape, mape / 6, rounding);
    EXPECT_NEAR(m.smape, (2.0 / 3 + 0 + 2 + 0 + 2.0 / 3 + 2) / 6, rounding);
    EXPECT_NEAR(m.mean_ratio[0], 2, rounding);
    EXPECT_NEAR(m.mean_ratio[1], 0.75, rounding);
    EXPECT_NEAR(m.mean_ratio[2], 1, rounding);
    EXPECT_NEAR(m.mean_ratio_total, 1, rounding);
    EXPECT_NEAR(m.mean_reference[1], 2, rounding);
}

TEST(Metrics, EqualImagesHaveNoError) {
    const Image image = from_values(1, 2, {0, 1, 2, 0, 0, 5});
    const ErrorMetrics m = compare_images(image, image);
    for (const MetricInfo& metric : metric_list())
        EXPECT_EQ(m.*metric.value, std::string(metric.name) == "mean_ratio" ? 1 : 0) << metric.name;
}

TEST(Metrics, BlackReferenceGivesZeroOrInfinityButNoNan) {
    const ErrorMetrics equal = compare_images(constant(2, 2, 0), constant(2, 2, 0));
    EXPECT_EQ(equal.rrmse, 0);
    EXPECT_EQ(equal.smape, 0);
    const ErrorMetrics different = compare_images(constant(2, 2, 1), constant(2, 2, 0));
    EXPECT_EQ(different.rrmse, std::numeric_limits<double>::infinity());
    EXPECT_EQ(different.smape, 2);
}

// A relative deviation of +-d at a constant reference c: closed forms, whatever c is.
TEST(Metrics, RelativeMetricsDoNotDependOnTheScale) {
    const double d = 0.125;
    for (const float c : {1e-6f, 1.0f, 1e6f}) {
        Image image = constant(32, 32, c);
        for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] *= static_cast<float>(1 + (i % 2 ? d : -d));
        const ErrorMetrics m = compare_images(image, constant(32, 32, c));
        // The float images hold c (1 +- d) to 2^-24; relative to d that is 5e-7.
        EXPECT_NEAR(m.rrmse, d / std::sqrt(1.001), 1e-6 * d);
        EXPECT_NEAR(m.relmse_trimmed, d * d / 1.001, 2e-6 * d * d);
        EXPECT_NEAR(m.mape, d / std::sqrt(1.001), 1e-6 * d);
        EXPECT_NEAR(m.smape, (2 * d / (2 + d) + 2 * d / (2 - d)) / 2, 1e-6 * d);
        EXPECT_NEAR(m.rmse, d * c, 1e-6 * d * c);
        EXPECT_NEAR(m.mean_ratio_total, 1, 1e-6);
    }
}

// Gaussian noise of known variance. The mean of n squares of unit normals has the standard deviation sqrt(2 / n); five
// of them are exceeded with probability 6e-7.
TEST(Metrics, KnownNoiseHasItsVariance) {
    const double sigma = 0.2;
    const int size = 256;
    Rng rng(1);
    Image image = constant(size, size, 1);
    for (float& v : image.rgb)
        v += static_cast<float>(sigma * std::sqrt(-2 * std::log(1 - rng.uniform())) * std::cos(2 * pi * rng.uniform()));
    const ErrorMetrics m = compare_images(image, constant(size, size, 1));
    const double n = 3.0 * size * size;
    EXPECT_NEAR(m.mse / sqr(sigma), 1, 5 * std::sqrt(2 / n));
    EXPECT_NEAR(sqr(m.rrmse / sigma) * 1.001, 1, 5 * std::sqrt(2 / n));
    // Mean of |normal| is sqrt(2/pi), its variance 1 - 2/pi.
    EXPECT_NEAR(m.mape * std::sqrt(1.001) / sigma, std::sqrt(2 / pi), 5 * std::sqrt((1 - 2 / pi) / n));
    EXPECT_NEAR(m.mean_ratio_total, 1, 5 * sigma / std::sqrt(n));
}

TEST(Metrics, TrimmingRemovesExactlyTheLargestPixels) {
    const Image reference = constant(100, 30, 1);  // 3000 pixels: three are removed
    Image image = reference;
    for (const int x : {3, 40, 77}) std::fill_n(image.pixel(x, x % 30), 3, 1000.0f);
    EXPECT_EQ(compare_images(image, reference).relmse_trimmed, 0);
    std::fill_n(image.pixel(50, 20), 3, 1.5f);
    EXPECT_NEAR(compare_images(image, reference).relmse_trimmed, 0.25 / 1.001 / 2997, rounding);
}

TEST(Metrics, MaskLeavesPixelsOut) {
    const Image reference = from_values(3, 1, {1, 1, 1, 2, 2, 2, 3, 3, 3});
    const Image image = from_values(3, 1, {1, 1, 1, 9, 9, 9, 4, 4, 4});
    const Image mask = from_values(3, 1, {1, 1, 1, 0, 0, 0, 0, 0.1f, 0});
    const ErrorMetrics m = compare_images(image, reference, &mask);
    EXPECT_EQ(m.pixels, 2u);
    EXPECT_EQ(m.masked, 1u);
    EXPECT_NEAR(m.mse, 0.5, rounding);
    EXPECT_NEAR(m.rrmse, std::sqrt(1 / (9 + 0.004) / 2), rounding);  // mean(R) = 2 over the two pixels
    EXPECT_NEAR(m.mean_ratio_total, 5.0 / 4, rounding);
}

TEST(Metrics, ValuesThatAreNotFiniteAreLeftOutAndCounted) {
    Image image = constant(2, 2, 1), reference = constant(2, 2, 1);
    image.pixel(0, 0)[1] = std::nanf("");
    reference.pixel(1, 1)[2] = std::numeric_limits<float>::infinity();
    image.pixel(0, 1)[0] = 4;
    const ErrorMetrics m = compare_images(image, reference);
    EXPECT_EQ(m.non_finite, 2u);
    EXPECT_EQ(m.pixels, 2u);
    EXPECT_NEAR(m.mse, 1.5, rounding);
}

TEST(Metrics, RelativeErrorsAverageToRrmse) {
    Rng rng(2);
    Image image(7, 5), reference(7, 5), mask = constant(7, 5, 1);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        image.rgb[i] = static_cast<float>(rng.uniform());
        reference.rgb[i] = static_cast<float>(rng.uniform());
    }
    std::fill_n(mask.pixel(3, 2), 3, 0.0f);
    const std::vector<double> errors = relative_errors(image, reference, &mask);
    double sum = 0;
    std::set<std::size_t> left_out;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        if (std::isnan(errors[i]))
            left_out.insert(i);
        else
            sum += sqr(errors[i]);
    }
    EXPECT_EQ(left_out, std::set<std::size_t>{3 + 2 * 7});
    EXPECT_NEAR(std::sqrt(sum / 34), compare_images(image, reference, &mask).rrmse, rounding);
}

template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Metrics, SizesMustBeEqual) {
    const Image a(4, 2), b(2, 4);
    EXPECT_THAT(refusal([&] { compare_images(a, b); }), HasSubstr("the image is 4x2 pixels and the reference is 2x4"));
    EXPECT_THAT(refusal([&] { relative_errors(a, a, &b); }), HasSubstr("the mask is 2x4 pixels"));
    const Image mask(4, 2);  // all black
    EXPECT_THAT(refusal([&] { compare_images(a, a, &mask); }), HasSubstr("no pixel is left"));
}

}  // namespace
}  // namespace keyhole
