#include "compare/false_colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "base/spectrum.h"
#include "base/srgb.h"

namespace keyhole {
namespace {

// CIE lightness of a linear colour, 0 to 100.
double lightness(const float* v) {
    const double y = luminance({v[0], v[1], v[2]});
    return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(FalseColour, LightnessGrowsEvenlyWithTheError) {
    constexpr int n = 101;
    std::vector<double> errors(n);
    for (int i = 0; i < n; ++i) errors[static_cast<std::size_t>(i)] = 0.05 * i;
    const Image image = false_colour(errors, n, 5.0);
    const double first = lightness(image.pixel(0, 0)), last = lightness(image.pixel(n - 1, 0));
    EXPECT_LT(first, 2);
    EXPECT_GT(last, 95);
    for (int x = 1; x < n; ++x) EXPECT_GT(lightness(image.pixel(x, 0)), lightness(image.pixel(x - 1, 0))) << x;
    // OpenImageIO interpolates the map between a few knots; a tenth of the range is far outside a straight line.
    for (int x = 0; x < n; ++x)
        EXPECT_NEAR(lightness(image.pixel(x, 0)), first + (last - first) * x / (n - 1), 10) << x;
}

TEST(FalseColour, LargerErrorsAreTheLastColourAndMissingOnesGrey) {
    const std::vector<double> errors = {1, 7, std::numeric_limits<double>::infinity(),
                                        std::numeric_limits<double>::quiet_NaN()};
    const Image image = false_colour(errors, 2, 1.0);
    ASSERT_EQ(image.height, 2);
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(image.pixel(1, 0)[c], image.pixel(0, 0)[c]);
        EXPECT_EQ(image.pixel(0, 1)[c], image.pixel(0, 0)[c]);
        EXPECT_FLOAT_EQ(image.pixel(1, 1)[c], static_cast<float>(srgb_decode(0.5)));
    }
}

TEST(FalseColour, QuantileIgnoresWhatIsNotANumber) {
    std::vector<double> errors;
    for (int i = 100; i >= 0; --i) errors.push_back(i);
    errors.push_back(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(error_quantile(errors, 0), 0);
    EXPECT_EQ(error_quantile(errors, 0.5), 50);
    EXPECT_EQ(error_quantile(errors, 1), 100);
    EXPECT_EQ(error_quantile({}, 0.5), 0);
}

}  // namespace
}  // namespace keyhole
