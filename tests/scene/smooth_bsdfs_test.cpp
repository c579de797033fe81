// The BSDFs without microfacets, in the suite of bsdf_harness.h and where they have known answers.
#include <gtest/gtest.h>

#include "bsdf_harness.h"
#include "scene/fresnel.h"

namespace keyhole {
namespace {

Spectrum gray(double v) { return Spectrum::Constant(v); }
const Spectrum white = Spectrum::Ones();
const ConductorIor gold{{0.14, 0.37, 1.44}, {3.98, 2.38, 1.60}};

BsdfPtr glossy_phong() { return make_phong(40, gray(0.3), gray(0.6)); }
std::shared_ptr<const Texture> half() { return constant_texture(gray(0.5)); }

std::vector<BsdfCase> cases() {
    const BsdfPtr lambert = make_diffuse(Spectrum(0.8, 0.5, 0.2)), white_wall = make_diffuse(white);
    const BsdfPtr glass = make_dielectric(1.5, white, white), mirror = make_conductor({}, white);
    const BsdfPtr plastic = make_plastic(1.49, gray(0.5), gray(0.8), true);
    std::vector<BsdfCase> list = {
        {.name = "diffuse", .bsdf = lambert},
        {.name = "diffuse_white", .bsdf = white_wall, .lossless_front = true},
        {.name = "diffuse_black", .bsdf = make_diffuse(gray(0))},
        {.name = "diffuse_textured", .bsdf = make_diffuse(half())},
        {.name = "conductor_mirror", .bsdf = mirror, .lossless_front = true},
        {.name = "conductor_gold", .bsdf = make_conductor(gold, gray(0.9))},
        {.name = "dielectric", .bsdf = glass, .eta = 1.5, .lossless_front = true, .lossless_back = true},
        {.name = "dielectric_bubble",
         .bsdf = make_dielectric(1 / 1.33, white, white),
         .eta = 1 / 1.33,
         .lossless_front = true,
         .lossless_back = true},
        {.name = "dielectric_matched",
         .bsdf = make_dielectric(1, white, white),
         .lossless_front = true,
         .lossless_back = true},
        // A reflectance of 1e-9.
        {.name = "dielectric_nearly_matched",
         .bsdf = make_dielectric(1 + 6.3e-5, white, white),
         .eta = 1 + 6.3e-5,
         .lossless_front = true,
         .lossless_back = true},
        {.name = "dielectric_tinted", .bsdf = make_dielectric(1.5, gray(0.2), Spectrum(0.9, 0.5, 0.1)), .eta = 1.5},
        {.name = "dielectric_opaque", .bsdf = make_dielectric(1.5, white, gray(0)), .eta = 1.5},
        {.name = "thin_dielectric",
         .bsdf = make_thin_dielectric(1.5, white, white),
         .lossless_front = true,
         .lossless_back = true},
        {.name = "plastic_white", .bsdf = make_plastic(1.49, white, white, false), .lossless_front = true},
        {.name = "plastic_nonlinear", .bsdf = plastic},
        {.name = "plastic_without_coat", .bsdf = make_plastic(1.49, Spectrum(0.8, 0.5, 0.2), gray(0), false)},
        {.name = "plastic_textured", .bsdf = make_plastic(1.8, half(), half(), true)},
        {.name = "phong", .bsdf = glossy_phong()},
        {.name = "phong_flat", .bsdf = make_phong(0, gray(0.5), gray(0.5))},
        {.name = "phong_narrow", .bsdf = make_phong(5000, gray(0.2), gray(0.7))},
        {.name = "phong_specular", .bsdf = make_phong(constant_texture(gray(30)), gray(0), half())},
        {.name = "null", .bsdf = make_null(), .lossless_front = true, .lossless_back = true},
        {.name = "mask", .bsdf = make_mask(make_two_sided(plastic, lambert), 0.3)},
        {.name = "mask_white",
         .bsdf = make_mask(glass, half()),
         .eta = 1.5,
         .lossless_front = true,
         .lossless_back = true},
        {.name = "mask_closed", .bsdf = make_mask(lambert, 1)},
        {.name = "mask_open", .bsdf = make_mask(lambert, 0), .lossless_front = true, .lossless_back = true},
        {.name = "two_sided", .bsdf = make_two_sided(glossy_phong(), lambert)},
        {.name = "two_sided_diffuse", .bsdf = make_two_sided(lambert, lambert)},
        {.name = "two_sided_white",
         .bsdf = make_two_sided(white_wall, mirror),
         .lossless_front = true,
         .lossless_back = true},
        {.name = "blend", .bsdf = make_blend(glossy_phong(), lambert, 0.25)},
        {.name = "blend_delta_and_smooth", .bsdf = make_blend(plastic, glass, half()), .eta = 1.5},
        // A narrow smooth lobe around a delta lobe.
        {.name = "blend_mirror_and_narrow",
         .bsdf = make_blend(mirror, make_rough_conductor(MicrofacetType::ggx, 1e-3, 1e-3, {}, white), 0.5)},
        {.name = "blend_nested",
         .bsdf = make_blend(make_blend(white_wall, mirror, 0.5), make_mask(white_wall, 0.6), 1.0 / 3),
         .lossless_front = true},
        {.name = "blend_overdriven", .bsdf = make_blend(lambert, glossy_phong(), constant_texture(gray(1.7)))},
    };
    for (const double slope : {0.2, 1.5}) {
        const auto waves = constant_texture(gray(0.5), {slope, -0.5 * slope});
        const std::string degree = slope < 1 ? "gentle" : "steep";
        list.push_back(
            {.name = "bump_phong_" + degree, .bsdf = make_bump_map(glossy_phong(), waves, 1), .reciprocal = false});
        list.push_back({.name = "bump_blend_" + degree,
                        .bsdf = make_bump_map(make_blend(make_two_sided(plastic, lambert), glass, 0.5), waves, 0.7),
                        .eta = 1.5,
                        .reciprocal = false});
    }
    return list;
}

INSTANTIATE_TEST_SUITE_P(Smooth, BsdfTest, testing::ValuesIn(cases()), bsdf_case_name);

// Reflectances of 0, 1e-9, 1 - 1e-9 and 1: both events are found again from numbers at either end of their intervals,
// and one that cannot happen has no inverse.
TEST(DielectricChoice, IsInvertedAtExtremeReflectances) {
    struct Extreme {
        double eta, cos;
        bool reflects, transmits;
    };
    for (const Extreme& e :
         {Extreme{1, 0.7, false, true}, Extreme{1 + 6.3e-5, 1, true, true}, Extreme{1.5, 2e-10, true, true},
          Extreme{1.5, 1e-13, true, true}, Extreme{1 / 1.5, 0.5, true, false}, Extreme{1 / 1.5, 1e-300, true, false}}) {
        const BsdfPtr glass = make_dielectric(e.eta, white, white);
        const Vec3 known(std::sqrt((1 - e.cos) * (1 + e.cos)), 0, e.cos);
        for (const Mode mode : {Mode::eye, Mode::light})
            for (const bool reflected : {true, false}) {
                std::uint8_t lobe = 0;
                bool seen = false;
                for (const double u : {0.0, one_minus_epsilon, 0.5, 1e-10}) {
                    const auto s = glass->sample(flat_point(), known, u, {0.5, 0.5}, mode);
                    ASSERT_TRUE(s && s->delta);
                    if ((s->w.z() > 0) != reflected) continue;
                    seen = true;
                    lobe = s->lobe;
                    for (const double place : {0.0, 0.3, one_minus_epsilon}) {
                        const auto n =
                            glass->invert(flat_point(), known, s->w, {true, lobe}, {0.5, place, {0.5, 0.5}}, mode);
                        ASSERT_TRUE(n);
                        const auto again = glass->sample(flat_point(), known, n->lobe, {0.5, 0.5}, mode);
                        ASSERT_TRUE(again && again->lobe == lobe && again->w == s->w) << e.eta << ", " << e.cos;
                    }
                }
                EXPECT_EQ(seen, reflected ? e.reflects : e.transmits) << e.eta << ", " << e.cos << ", " << reflected;
            }
    }
}

}  // namespace
}  // namespace keyhole
