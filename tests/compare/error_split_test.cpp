#include "compare/error_split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "compare/metrics.h"

namespace keyhole {
namespace {

Image constant(int width, int height, float value) {
    Image image(width, height);
    std::fill(image.rgb.begin(), image.rgb.end(), value);
    return image;
}

// A reference of 2 everywhere: w = 1 / (4 + 0.001 * 4).
constexpr double w = 1 / 4.004;

// Two runs, 1 and 5 in every value: sample variance 8, mean 3, squared bias (3 - 2)^2 - 8 / 2.
TEST(ErrorSplit, OfTwoRunsByHand) {
    const std::vector<Image> runs = {constant(2, 1, 1), constant(2, 1, 5)};
    const ErrorSplit split = split_error(runs, constant(2, 1, 2), nullptr);
    EXPECT_NEAR(split.variance.mean, 8 * w, 1e-12);
    EXPECT_NEAR(split.squared_bias.mean, (1 - 4) * w, 1e-12);
    EXPECT_FALSE(split.variance.interval) << "two runs leave one, which has no variance";
}

// 1, 2, 6: mean 3, sample variance 7. Without the first: mean 4, variance 8; the second: 3.5, 12.5; the third: 1.5,
// 0.5. The pseudo-values of the variance are 3 * 7 - 2 * 8 = 5, -4 and 20.
TEST(ErrorSplit, OfThreeRunsByHand) {
    const std::vector<Image> runs = {constant(1, 2, 1), constant(1, 2, 2), constant(1, 2, 6)};
    const Image variance = constant(1, 2, 0.5f);
    const ErrorSplit split = split_error(runs, constant(1, 2, 2), &variance);
    EXPECT_NEAR(split.variance.mean, 7 * w, 1e-12);
    const double standard_error = std::sqrt((4.0 + 121 + 169) / 2 / 3);
    EXPECT_NEAR(split.variance.interval->high, (7 + student_quantile(2) * standard_error) * w, 1e-9);
    const auto bias = [](double mean, double v, double n) { return (mean - 2) * (mean - 2) - v / n - 0.5; };
    EXPECT_NEAR(split.squared_bias.mean, bias(3, 7, 3) * w, 1e-12);
    const double whole = bias(3, 7, 3);
    const Estimate expected = jackknife(whole, std::array{bias(4, 8, 2), bias(3.5, 12.5, 2), bias(1.5, 0.5, 2)});
    EXPECT_NEAR(split.squared_bias.interval->low, expected.interval->low * w, 1e-9);
}

TEST(ErrorSplit, LeavesOutWhatIsNotFinite) {
    std::vector<Image> runs = {constant(2, 1, 1), constant(2, 1, 5)};
    runs[0].rgb[4] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NEAR(split_error(runs, constant(2, 1, 2), nullptr).variance.mean, 8 * w, 1e-12);
}

TEST(ErrorSplit, OfTheReferenceItself) {
    EXPECT_NEAR(reference_relmse(constant(3, 2, 2), constant(3, 2, 0.25f)), 0.25 * w, 1e-9);
}

// Images of independent normal noise around a biased truth, and a reference with noise of its own.
struct Simulation {
    static constexpr double bias = 0.1, noise = 0.5, reference_noise = 0.05, truth = 2;
    std::mt19937 random{2};

    Image image(double mean, double deviation) {
        std::normal_distribution<float> normal(static_cast<float>(mean), static_cast<float>(deviation));
        Image result(8, 8);
        for (float& v : result.rgb) v = normal(random);
        return result;
    }
    ErrorSplit split(int runs, const Image& variance) {
        std::vector<Image> images;
        for (int r = 0; r < runs; ++r) images.push_back(image(truth + bias, noise));
        return split_error(images, image(truth, reference_noise), &variance);
    }
};

// 400 comparisons of 6 runs. Both parts are known to about 1% then; w of a reference with noise is off by 0.25%.
// The intervals do not know of the reference's noise, which adds a tenth to the squared bias' spread here. Misses of 5%
// have a standard deviation of 4.4; of 400, 20 +- 25 goes wrong less than once in 10^6.
TEST(ErrorSplit, FindsKnownNoiseAndBias) {
    Simulation s;
    const Image variance = constant(8, 8, static_cast<float>(s.reference_noise * s.reference_noise));
    const double true_variance = s.noise * s.noise * w, true_bias = s.bias * s.bias * w;
    double sum_variance = 0, sum_bias = 0;
    int missed_variance = 0, missed_bias = 0;
    for (int i = 0; i < 400; ++i) {
        const ErrorSplit split = s.split(6, variance);
        sum_variance += split.variance.mean / 400;
        sum_bias += split.squared_bias.mean / 400;
        const auto misses = [](const Estimate& e, double truth) {
            return e.interval->low > truth || e.interval->high < truth;
        };
        missed_variance += misses(split.variance, true_variance);
        missed_bias += misses(split.squared_bias, true_bias);
    }
    EXPECT_NEAR(sum_variance, true_variance, 0.02 * true_variance);
    EXPECT_NEAR(sum_bias, true_bias, 0.15 * true_bias);
    EXPECT_LT(missed_variance, 45);
    EXPECT_LT(missed_bias, 60);
}

}  // namespace
}  // namespace keyhole
