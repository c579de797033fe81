#include "render/film.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"

namespace keyhole {
namespace {

FilmSettings settings(int width, int height, const ReconstructionFilter& filter) {
    FilmSettings s;
    s.width = s.crop_width = width;
    s.height = s.crop_height = height;
    s.filter = filter;
    return s;
}

struct Splat {
    Vec2 raster;
    Spectrum value;
};

std::vector<Splat> some_splats(int n) {
    Rng rng(3);
    std::vector<Splat> splats;
    for (int i = 0; i < n; ++i) {
        const double x = 10 * rng.uniform() - 1, y = 10 * rng.uniform() - 1;
        splats.push_back({{x, y}, Spectrum(rng.uniform(), 1e-6 * rng.uniform(), 1e4 * rng.uniform())});
    }
    return splats;
}

template <class Film>
class Films : public testing::Test {};
using FilmTypes = testing::Types<MetropolisFilm, RadianceFilm>;
TYPED_TEST_SUITE(Films, FilmTypes);

TYPED_TEST(Films, OrderAndSplittingDoNotChangeABit) {
    for (const auto& filter : {make_box_filter(), make_tent_filter(), make_gaussian_filter()}) {
        const FilmSettings s = settings(8, 8, filter);
        std::vector<Splat> splats = some_splats(5000);
        TypeParam forward(s), backward(s), part(s);
        for (const Splat& x : splats) forward.splat(x.raster, x.value);
        std::reverse(splats.begin(), splats.end());
        for (std::size_t i = 0; i < splats.size(); ++i)
            (i % 3 ? backward : part).splat(splats[i].raster, splats[i].value);
        EXPECT_FALSE(forward == backward);
        backward.merge(part);
        EXPECT_TRUE(forward == backward);
    }
}

TYPED_TEST(Films, ManySplatsIntoOnePixelDoNotSaturate) {
    TypeParam film(settings(1, 1, make_box_filter()));
    constexpr int n = 1 << 25;  // where a sum of ones in single precision has stopped growing
    for (int i = 0; i < n; ++i) film.splat({0.5, 0.5}, Spectrum::Constant(1.0));
    EXPECT_EQ(film.develop(1).rgb[0], static_cast<float>(n));
}

TYPED_TEST(Films, ASplatIsSpreadByTheFilterAndLosesNothingInside) {
    TypeParam film(settings(8, 8, make_tent_filter()));
    film.splat({4.25, 3.5}, Spectrum::Constant(2));
    const Image image = film.develop(1);
    double sum = 0;
    for (const float v : image.rgb) sum += v / 3;
    EXPECT_NEAR(sum, 2, 1e-6);
    EXPECT_NEAR(image.pixel(4, 3)[0], 1.5, 1e-6);
    EXPECT_NEAR(image.pixel(3, 3)[0], 0.5, 1e-6);
}

TYPED_TEST(Films, SplatsOfAnySizeAreRoundedToTheLastBit) {
    for (double value = 1e-3; value < 1e11; value *= 10) {
        TypeParam film(settings(8, 8, make_tent_filter()));
        film.splat({4.25, 3.5}, Spectrum(value, 0, value / 3));
        const Image image = film.develop(1);
        const double rounding = 0x1p-25;
        EXPECT_NEAR(image.pixel(4, 3)[0], 0.75 * value, rounding + 1e-7 * value);
        EXPECT_EQ(image.pixel(4, 3)[1], 0);
        EXPECT_NEAR(image.pixel(3, 3)[2], 0.25 * value / 3, rounding + 1e-7 * value);
    }
}

TYPED_TEST(Films, SplatsOutsideTheCropWindowAreDropped) {
    FilmSettings s = settings(8, 8, make_box_filter());
    s.crop_x = 2;
    s.crop_y = 3;
    s.crop_width = 4;
    s.crop_height = 2;
    TypeParam film(s);
    film.splat({1.9, 3.5}, Spectrum::Constant(1));
    film.splat({2.1, 5.0}, Spectrum::Constant(1));
    film.splat({2.1, 3.1}, Spectrum::Constant(1));
    const Image image = film.develop(1);
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.pixel(0, 0)[0], 1);
    EXPECT_EQ(std::count(image.rgb.begin(), image.rgb.end(), 0.0f), 4 * 2 * 3 - 3);
}

}  // namespace
}  // namespace keyhole
