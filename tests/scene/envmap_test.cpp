// Environment maps: orientation, interpolation, and a sampler whose density is exact whatever the image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "base/rng.h"
#include "base/srgb.h"
#include "base/warp.h"
#include "emitter_checks.h"
#include "image_on_disk.h"
#include "scene/emitters.h"
#include "statistics.h"

namespace keyhole {
namespace {

struct Sky {
    std::string name;
    int width, height;
    std::vector<float> texels;  // RGB, rows from the top
};

void PrintTo(const Sky& sky, std::ostream* out) { *out << sky.name; }

Sky random_sky(int width, int height) {
    Rng rng(5, static_cast<std::uint64_t>(width * 1000 + height));
    Sky sky{"random" + std::to_string(width) + "x" + std::to_string(height), width, height, {}};
    for (int i = 0; i < 3 * width * height; ++i) sky.texels.push_back(static_cast<float>(rng.uniform()));
    return sky;
}
// Zero but for two texels, the one 1e6 times the other.
Sky sun_sky() {
    Sky sky{"sun", 6, 4, std::vector<float>(72, 0.0f)};
    sky.texels[3 * (1 * 6 + 5)] = 1e6f;
    sky.texels[3 * (2 * 6 + 2) + 1] = 1;
    return sky;
}
// 1e6 to 1 everywhere, at the poles too.
Sky checkered_sky() {
    Sky sky{"checkered", 4, 4, {}};
    for (int i = 0; i < 48; ++i) sky.texels.push_back((i / 3 + i / 12) % 2 == 0 ? 1e6f : 1.0f);
    return sky;
}
Sky black_sky() { return {"black", 3, 2, std::vector<float>(18, 0.0f)}; }
std::vector<Sky> skies() {
    return {random_sky(1, 1), random_sky(2, 1), random_sky(1, 3), random_sky(7, 5),
            sun_sky(),        checkered_sky(),  black_sky()};
}

Affine pose() {
    Affine result = Affine::Identity();
    result.translate(Vec3(3, -2, 5)).rotate(Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized())).scale(3);
    return result;
}

std::unique_ptr<Emitter> make(const Sky& sky, double scale = 1, const Affine& to_world = pose()) {
    const ImageOnDisk file(".exr", OIIO::TypeDesc::FLOAT, sky.width, sky.height, 3, sky.texels);
    auto emitter = make_envmap_emitter({file.path(), scale, to_world});
    emitter->set_scene_bounds({1, 2, 3}, 2);
    return emitter;
}

EmitterPoint towards(const Vec3& d) { return {d, Vec3::Zero()}; }
Spectrum seen(const Emitter& emitter, const Vec3& d) { return emitter.radiance(towards(d), -d); }

// A direction by Mitsuba's (u, v).
Vec3 direction(double u, double v) {
    return {std::sin(pi * v) * std::sin(2 * pi * u), std::cos(pi * v), -std::sin(pi * v) * std::cos(2 * pi * u)};
}

// The definition once more, in other words: weights of the texel centres around (u, v).
Spectrum interpolated(const Sky& sky, double u, double v) {
    Spectrum sum = Spectrum::Zero();
    const auto hat = [](double x) { return std::max(0.0, 1 - std::abs(x)); };
    const double y = std::clamp(v * sky.height - 0.5, 0.0, sky.height - 1.0);
    for (int row = 0; row < sky.height; ++row)
        for (int column = -1; column <= sky.width; ++column) {
            const double weight = hat(u * sky.width - 0.5 - column) * hat(y - row);
            const std::size_t texel = 3 * (row * sky.width + (column + sky.width) % sky.width);
            for (int k = 0; k < 3; ++k) sum[k] += weight * double(sky.texels[texel + k]);
        }
    return sum;
}

class EnvmapTest : public testing::TestWithParam<Sky> {
  protected:
    const Sky& sky = GetParam();
    std::unique_ptr<Emitter> emitter = make(sky);
    Rng rng{9};
    Vec2 uniform2() {
        const double a = rng.uniform();
        return {a, rng.uniform()};
    }
};

TEST_P(EnvmapTest, SamplesCarryTheirDensities) { EXPECT_TRUE(samples_carry_their_densities(*emitter)); }
TEST_P(EnvmapTest, SurvivesTheEndsOfTheUnitInterval) {
    EXPECT_TRUE(survives_the_ends_of_the_unit_interval(*emitter));
}
TEST_P(EnvmapTest, RaysFollowTheirDensity) { EXPECT_TRUE(rays_follow_their_density(*emitter, {1, 2, 3}, 2)); }
TEST_P(EnvmapTest, InverseGivesTheSample) { EXPECT_TRUE(inverse_gives_the_sample(*emitter)); }
TEST_P(EnvmapTest, InverseNumbersAreUniform) { EXPECT_TRUE(inverse_numbers_are_uniform(*emitter)); }
TEST_P(EnvmapTest, PowerIsTheIntegralOfWhatIsEmitted) { EXPECT_TRUE(power_is_the_integral(*emitter)); }

TEST_P(EnvmapTest, InterpolatesBetweenTexelCentres) {
    for (int i = 0; i < 2000; ++i) {
        const Vec2 uv = uniform2();
        const Spectrum expected = interpolated(sky, uv.x(), uv.y());
        const Vec3 d = pose().linear() / 3 * direction(uv.x(), uv.y());
        EXPECT_LE((seen(*emitter, d) - expected).abs().maxCoeff(), 1e-8 * (1 + expected.maxCoeff())) << uv.transpose();
    }
}

// The density is bilinear in u and cos(theta) between texel centres, so the midpoint rule over parts of such cells
// gives exact probabilities. False alarm: 1e-3 over all images.
TEST_P(EnvmapTest, PointsFollowTheirDensity) {
    const int parts = 4, samples = 100000;
    const int columns = parts * sky.width, rows = parts * (sky.height + 1);
    std::vector<double> edges;  // of the rows of parts, in cos(theta)
    const auto cosine = [&](int row) { return std::cos(pi * std::clamp((row - 0.5) / sky.height, 0.0, 1.0)); };
    for (int row = 0; row < sky.height + 1; ++row)
        for (int part = 0; part < parts; ++part)
            edges.push_back(cosine(row) + (cosine(row + 1) - cosine(row)) * part / parts);
    edges.push_back(-1);
    const Eigen::Matrix3d rotation = pose().linear() / 3;

    std::vector<double> expected, observed(static_cast<std::size_t>(rows) * columns);
    double total = 0;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double u = (0.5 + (column + 0.5) / parts) / sky.width, c = (edges[row] + edges[row + 1]) / 2;
            const Vec3 d = rotation * direction(u, std::acos(c) / pi);
            const double p = emitter->pdf_point(towards(d)) * 2 * pi / columns * (edges[row] - edges[row + 1]);
            expected.push_back(samples * p);
            total += p;
        }
    EXPECT_NEAR(total, 1, 1e-7);
    for (int i = 0; i < samples; ++i) {
        const double u_part = rng.uniform();
        const Vec3 d = rotation.transpose() * emitter->sample_point(u_part, uniform2()).p;
        double u = std::atan2(d.x(), -d.z()) / (2 * pi) - 0.5 / sky.width;
        u -= std::floor(u);
        const auto edge = std::lower_bound(edges.begin() + 1, edges.end() - 1, d.y(), std::greater<>());
        const auto row = edge - edges.begin() - 1,
                   column = std::min<std::ptrdiff_t>(columns - 1, std::ptrdiff_t(u * columns));
        ++observed[static_cast<std::size_t>(row * columns + column)];
    }
    EXPECT_GT(chi_square_p_value(expected, observed), sidak_level(1e-3, static_cast<int>(skies().size())));
}

TEST_P(EnvmapTest, DensityIsPositiveWhereTheRadianceIs) {
    const bool black = sky.name == "black";
    for (int i = 0; i < 5000; ++i) {
        const Vec3 d = square_to_sphere(uniform2());
        const double pdf = emitter->pdf_point(towards(d)), value = luminance(seen(*emitter, d));
        EXPECT_TRUE(black || (pdf > 0) == (value > 0)) << pdf << " " << value;
        // The estimate of the power by one direction stays bounded. Over the bilinear interpolant in u and cos(theta)
        // the one in u and v is at most the largest slope of v in the cosine, 3 in the cell next to a polar half row
        // (images of one row have none); the two integrals differ by less than a factor 2.
        EXPECT_TRUE(black || value * 4 * pi <= 6 * pdf * luminance(emitter->power())) << value << " " << pdf;
    }
}

TEST_P(EnvmapTest, PolesAndSeamAreOrdinaryPlaces) {
    const Eigen::Matrix3d rotation = pose().linear() / 3;
    for (const Vec3& local : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(-0.0, 0, -1)}) {
        const Vec3 d = rotation * local;
        EXPECT_TRUE(std::isfinite(emitter->pdf_point(towards(d)))) << local.transpose();
        EXPECT_TRUE(seen(*emitter, d).allFinite()) << local.transpose();
    }
}

INSTANTIATE_TEST_SUITE_P(All, EnvmapTest, testing::ValuesIn(skies()), [](const auto& sky) { return sky.param.name; });

// Four texels on the equator of a 4x1 image: u = 1/8, 3/8, 5/8, 7/8.
TEST(Envmap, HasMitsubasOrientation) {
    const Sky sky{"", 4, 2, {1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0, 6, 0, 0, 7, 0, 0, 8, 0, 0}};
    const auto emitter = make(sky, 1, Affine::Identity());
    const double h = std::sqrt(0.5), top = std::cos(pi / 4);
    const auto at = [&](double x, double y, double z) { return seen(*emitter, {h * x, y, h * z})[0]; };
    EXPECT_NEAR(at(h, top, -h), 1, 1e-12);
    EXPECT_NEAR(at(h, top, h), 2, 1e-12);
    EXPECT_NEAR(at(-h, top, h), 3, 1e-12);
    EXPECT_NEAR(at(-h, top, -h), 4, 1e-12);
    EXPECT_NEAR(at(h, -top, -h), 5, 1e-12);
    EXPECT_NEAR(at(-h, -top, -h), 8, 1e-12);
    EXPECT_NEAR(at(0, top, -1), 2.5, 1e-12);  // the seam: half-way between the last and the first column
    EXPECT_NEAR(seen(*emitter, {0, 1, 0})[0], 2.5, 1.5);
}

TEST(Envmap, ScaleMultipliesRadianceAndPower) {
    const Sky sky = random_sky(5, 3);
    const auto plain = make(sky), scaled = make(sky, 2.5), dark = make(sky, 0);
    const Vec3 d = Vec3(1, 2, 3).normalized();
    EXPECT_NEAR(seen(*scaled, d)[1] / seen(*plain, d)[1], 2.5, 1e-14);
    EXPECT_NEAR(scaled->power()[1] / plain->power()[1], 2.5, 1e-14);
    EXPECT_EQ(dark->power()[1], 0);
    EXPECT_EQ(scaled->pdf_point(towards(d)), plain->pdf_point(towards(d)));
}

TEST(Envmap, PowerOfAConstantImageIsThatOfTheConstantEmitter) {
    const auto emitter = make({"", 16, 9, std::vector<float>(3 * 16 * 9, 0.5f)});
    const auto constant = make_constant_emitter({0.5, 0.5, 0.5});
    constant->set_scene_bounds({1, 2, 3}, 2);
    EXPECT_NEAR(emitter->power()[2] / constant->power()[2], 1, 1e-12);
    EXPECT_NEAR(emitter->pdf_point(towards({0.6, 0, 0.8})), 1 / (4 * pi), 1e-12);
}

TEST(Envmap, DecodesEightBitFilesFromSrgb) {
    const ImageOnDisk file(".png", OIIO::TypeDesc::UINT8, 1, 1, 1, std::vector<std::uint8_t>{188});
    const auto emitter = make_envmap_emitter({file.path(), 1, Affine::Identity()});
    EXPECT_NEAR(seen(*emitter, {0, 0, 1})[0], srgb_decode(188 / 255.0), 1e-7);
}

TEST(Envmap, RefusesWhatItCannotBe) {
    const Sky sky = random_sky(2, 2);
    Affine sheared = Affine::Identity();
    sheared.matrix()(0, 1) = 0.5;
    EXPECT_THROW(make(sky, -1), std::invalid_argument);
    EXPECT_THROW(make(sky, 1, sheared), std::invalid_argument);
    EXPECT_THROW(make_envmap_emitter({"/nowhere/sky.exr", 1, Affine::Identity()}), InputError);
}

}  // namespace
}  // namespace keyhole
