// Bitmaps and checkerboards.
#include "scene/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/rng.h"
#include "base/srgb.h"
#include "image_on_disk.h"

namespace keyhole {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Floats = std::vector<float>;

std::unique_ptr<Texture> bitmap(const ImageOnDisk& file, bool raw = false,
                                TextureFilter filter = TextureFilter::bilinear, TextureWrap wrap = TextureWrap::repeat,
                                const Eigen::Matrix3d& to_uv = Eigen::Matrix3d::Identity()) {
    return make_bitmap({file.path(), raw, filter, wrap, to_uv});
}

void expect_color(const Spectrum& found, const Spectrum& expected, double tolerance = 1e-14) {
    EXPECT_LE((found - expected).abs().maxCoeff(), tolerance)
        << found.transpose() << " instead of " << expected.transpose();
}

// A float image of one channel with these texels (x, y).
double value(int x, int y) { return 0.1 + x * 0.37 + y * y * 0.21 + x * y * 0.05; }
ImageOnDisk ramp(int width, int height) {
    Floats values;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) values.push_back(static_cast<float>(value(x, y)));
    return {".exr", OIIO::TypeDesc::FLOAT, width, height, 1, values};
}

TEST(Bitmap, DecodesEightBitFilesFromSrgb) {
    const ImageOnDisk file(".png", OIIO::TypeDesc::UINT8, 1, 1, 3, Bytes{255, 128, 3});
    expect_color(bitmap(file)->eval({0.3, 0.3}), {1, srgb_decode(128 / 255.0), 3 / 255.0 / 12.92});
    expect_color(bitmap(file, true)->eval({0.3, 0.3}), {1, 128 / 255.0, 3 / 255.0});
    EXPECT_NEAR(bitmap(file)->maximum(), 1, 1e-15);
}

TEST(Bitmap, DecodesSixteenBitFilesFromSrgb) {
    const ImageOnDisk file(".png", OIIO::TypeDesc::UINT16, 1, 1, 1, std::vector<std::uint16_t>{30000});
    expect_color(bitmap(file)->eval({0, 0}), Spectrum::Constant(srgb_decode(30000 / 65535.0)), 1e-7);
    expect_color(bitmap(file, true)->eval({0, 0}), Spectrum::Constant(30000 / 65535.0), 1e-7);
}

TEST(Bitmap, TakesFloatFilesAsTheyAre) {
    const ImageOnDisk file(".exr", OIIO::TypeDesc::FLOAT, 1, 1, 3, Floats{0.25f, 1000, 0});
    expect_color(bitmap(file)->eval({0, 0}), {0.25, 1000, 0});
    const ImageOnDisk half(".exr", OIIO::TypeDesc::HALF, 1, 1, 1, std::vector<std::uint16_t>{0x3800});
    expect_color(bitmap(half)->eval({0, 0}), Spectrum::Constant(0.5));
}

TEST(Bitmap, OneToFourChannelsAlphaIgnored) {
    const auto at_center = [](int channels, const Bytes& texel) {
        return bitmap({".png", OIIO::TypeDesc::UINT8, 1, 1, channels, texel}, true)->eval({0.5, 0.5});
    };
    expect_color(at_center(1, {51}), {0.2, 0.2, 0.2});
    expect_color(at_center(2, {51, 102}), {0.2, 0.2, 0.2});
    expect_color(at_center(3, {51, 102, 204}), {0.2, 0.4, 0.8});
    expect_color(at_center(4, {51, 102, 204, 51}), {0.2, 0.4, 0.8});
}

TEST(Bitmap, KeepsEightBitFilesEightBit) {
    const ImageOnDisk file(".png", OIIO::TypeDesc::UINT8, 200, 100, 3, Bytes(60000, 7));
    const auto texture = bitmap(file);
    EXPECT_LT(texture->bytes(), 61000u);
    EXPECT_GE(texture->bytes(), 60000u);
}

TEST(Bitmap, BottomLeftIsTheOrigin) {
    const ImageOnDisk file(".png", OIIO::TypeDesc::UINT8, 2, 2, 1, Bytes{0, 51, 102, 204});
    const auto texture = bitmap(file, true, TextureFilter::nearest);
    EXPECT_NEAR(texture->eval({0.25, 0.75})[0], 0.0, 1e-15);
    EXPECT_NEAR(texture->eval({0.75, 0.75})[0], 0.2, 1e-15);
    EXPECT_NEAR(texture->eval({0.25, 0.25})[0], 0.4, 1e-15);
    EXPECT_NEAR(texture->eval({0.75, 0.25})[0], 0.8, 1e-15);
    EXPECT_NEAR(texture->mean()[0], 1.4 / 4, 1e-15);
    EXPECT_NEAR(texture->maximum(), 0.8, 1e-15);
}

// Float texels: the file rounds to 6e-8 relative.
TEST(Bitmap, BilinearInterpolatesTexelCentres) {
    const ImageOnDisk file = ramp(4, 3);
    const auto texture = bitmap(file);
    const auto at = [&](double x, double y) { return texture->eval({x / 4, 1 - y / 3})[0]; };  // image coordinates
    EXPECT_NEAR(at(1.5, 0.5), value(1, 0), 1e-6);
    EXPECT_NEAR(at(2.0, 0.5), (value(1, 0) + value(2, 0)) / 2, 1e-6);
    const double left = 0.6 * value(1, 1) + 0.4 * value(1, 2), right = 0.6 * value(2, 1) + 0.4 * value(2, 2);
    EXPECT_NEAR(at(1.75, 1.9), 0.75 * left + 0.25 * right, 1e-6);
}

TEST(Bitmap, WrapModes) {
    const ImageOnDisk file = ramp(4, 3);
    struct Case {
        TextureWrap wrap;
        int texel[12];  // that stands for columns -4 to 7
    };
    for (const auto& c : {Case{TextureWrap::repeat, {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}},
                          Case{TextureWrap::mirror, {3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0}},
                          Case{TextureWrap::clamp, {0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3}}})
        for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::bilinear}) {
            const auto texture = bitmap(file, true, filter, c.wrap);
            for (int i = 0; i < 12; ++i)
                EXPECT_NEAR(texture->eval({(i - 4 + 0.5) / 4, 1 - 0.5 / 3})[0], value(c.texel[i], 0), 1e-6);
            if (filter == TextureFilter::nearest) continue;
            // Half-way between columns 3 and 4.
            EXPECT_NEAR(texture->eval({1, 1 - 0.5 / 3})[0], (value(3, 0) + value(c.texel[8], 0)) / 2, 1e-6);
        }
}

TEST(Bitmap, SingleTexelIsConstant) {
    const ImageOnDisk file(".png", OIIO::TypeDesc::UINT8, 1, 1, 1, Bytes{51});
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp})
        for (const double u : {-7.3, 0.0, 0.2, 1.0, 1e15}) {
            const auto texture = bitmap(file, true, TextureFilter::bilinear, wrap);
            EXPECT_NEAR(texture->eval({u, -u})[0], 0.2, 1e-15);
            EXPECT_EQ(texture->gradient({u, -u}), Vec2(0, 0));
        }
}

TEST(Bitmap, GradientIsTheDerivative) {
    const ImageOnDisk file = ramp(5, 4);
    Eigen::Matrix3d to_uv;
    to_uv << 1.3, 0.4, 0.2, -0.7, 2.1, 0.05, 0, 0, 1;
    const double h = 1e-6;
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp}) {
        const auto texture = bitmap(file, true, TextureFilter::bilinear, wrap, to_uv);
        const auto at = [&](double u, double v) { return luminance(texture->eval({u, v})); };
        Rng rng(5);
        int compared = 0;
        for (int i = 0; i < 300; ++i) {
            const double u = 4 * rng.uniform() - 2, v = 4 * rng.uniform() - 2, here = at(u, v);
            const Vec2 before((here - at(u - h, v)) / h, (here - at(u, v - h)) / h);
            const Vec2 after((at(u + h, v) - here) / h, (at(u, v + h) - here) / h);
            if ((before - after).norm() > 1e-3) continue;  // at a kink
            ++compared;
            // Within a cell the interpolant is quadratic, so central differences err by rounding only, 1e-15 / h.
            EXPECT_LE((texture->gradient({u, v}) - (before + after) / 2).norm(), 1e-8);
        }
        EXPECT_GT(compared, 290);
    }
}

TEST(Bitmap, CoordinatesThatAreNotFiniteGiveNan) {
    const ImageOnDisk file = ramp(4, 3);
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(std::isnan(bitmap(file)->eval({nan, 0.5})[0]));
    EXPECT_TRUE(std::isnan(bitmap(file)->eval({0.5, inf})[0]));
}

std::string message_of(const std::string& filename) {
    try {
        make_bitmap({filename});
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Bitmap, NamesWhatIsWrongWithAFile) {
    using testing::HasSubstr;
    EXPECT_THAT(message_of("/nowhere/a b.png"), HasSubstr("cannot use image '/nowhere/a b.png'"));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const ImageOnDisk bad(".exr", OIIO::TypeDesc::FLOAT, 2, 2, 1, Floats{1, 1, 1, nan});
    EXPECT_THAT(message_of(bad.path()), HasSubstr("column 1, row 1 is nan"));
    const ImageOnDisk negative(".exr", OIIO::TypeDesc::FLOAT, 2, 1, 3, Floats{0, 0, 0, 0, -1, 0});
    EXPECT_THAT(message_of(negative.path()), HasSubstr("column 1, row 0 is -1"));
    const ImageOnDisk many(".exr", OIIO::TypeDesc::FLOAT, 1, 1, 5, Floats(5, 1), {"a", "b", "c", "d", "e"});
    EXPECT_THAT(message_of(many.path()), HasSubstr("5 channels"));
    const ImageOnDisk layers(".exr", OIIO::TypeDesc::FLOAT, 1, 1, 5, Floats{1, 2, 3, 1, 9}, {"R", "G", "B", "A", "Z"});
    expect_color(bitmap(layers)->eval({0, 0}), {1, 2, 3});
}

TEST(Bitmap, RefusesBrokenFiles) {
    const ImageOnDisk file(".png", OIIO::TypeDesc::UINT8, 64, 64, 3, Bytes(64 * 64 * 3, 9));
    std::filesystem::resize_file(file.path(), 60);
    EXPECT_THAT(message_of(file.path()), testing::HasSubstr("cannot use image"));
    std::ofstream(file.path()) << "not an image";
    EXPECT_THAT(message_of(file.path()), testing::HasSubstr("cannot use image"));
}

TEST(Checkerboard, HasMitsubasPatternInFlippedV) {
    const Spectrum a(0.1, 0.2, 0.3), b(0.7, 0.8, 1.5);
    const auto texture = make_checkerboard(a, b, Eigen::Matrix3d::Identity());
    expect_color(texture->eval({0.25, 0.75}), a);
    expect_color(texture->eval({0.75, 0.25}), a);
    expect_color(texture->eval({0.25, 0.25}), b);
    expect_color(texture->eval({0.75, 0.75}), b);
    expect_color(texture->eval({-0.25, 3.25}), a);
    expect_color(texture->mean(), {0.4, 0.5, 0.9}, 1e-15);
    EXPECT_EQ(texture->maximum(), 1.5);
    EXPECT_EQ(texture->gradient({0.3, 0.3}), Vec2(0, 0));
}

TEST(Checkerboard, AppliesToUvAfterTheFlip) {
    Eigen::Matrix3d to_uv = Eigen::Matrix3d::Identity();
    to_uv(0, 0) = 10;
    to_uv(1, 1) = 2;
    to_uv(1, 2) = 0.5;
    const auto texture = make_checkerboard({0, 0, 0}, {1, 1, 1}, to_uv);
    for (const Vec2& uv : {Vec2(0.01, 0.9), Vec2(0.06, 0.9), Vec2(0.13, 0.3), Vec2(0.99, 0.55)}) {
        const double x = 10 * uv.x(), y = 2 * (1 - uv.y()) + 0.5;
        const bool same = (x - std::floor(x) > 0.5) == (y - std::floor(y) > 0.5);
        EXPECT_EQ(texture->eval(uv)[0], same ? 0 : 1) << uv.transpose();
    }
}

}  // namespace
}  // namespace keyhole
