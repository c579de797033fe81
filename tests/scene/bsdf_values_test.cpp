// BSDFs where their values are known: by closed forms, and by what nesting has to preserve.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "base/rng.h"
#include "base/warp.h"
#include "bsdf_harness.h"
#include "scene/fresnel.h"

namespace keyhole {
namespace {

using testing::ElementsAre;

const Spectrum white = Spectrum::Ones();
Spectrum gray(double v) { return Spectrum::Constant(v); }
Vec3 at_degrees(double theta, double phi = 0.3) {
    const double r = std::sin(theta * pi / 180);
    return {r * std::cos(phi), r * std::sin(phi), std::cos(theta * pi / 180)};
}

// Every lobe index that turns up in 2000 samples from +z.
std::set<int> lobes_seen(const Bsdf& bsdf) {
    std::set<int> seen;
    for (int i = 0; i < 2000; ++i)
        if (const auto s = bsdf.sample(flat_point(), at_degrees(40), i / 2000.0, {0.3, 0.6}, Mode::eye))
            seen.insert(s->lobe);
    return seen;
}

TEST(Diffuse, IsReflectanceOverPi) {
    const BsdfPtr bsdf = make_diffuse(Spectrum(0.8, 0.5, 0.2));
    const BsdfValue v = bsdf->eval(flat_point(), at_degrees(10), at_degrees(60));
    EXPECT_DOUBLE_EQ(v.f[1], 0.5 / pi);
    EXPECT_DOUBLE_EQ(v.pdf_light, 0.5 / pi);
    EXPECT_FALSE(make_diffuse(gray(0))->sample(flat_point(), at_degrees(10), 0, {0.1, 0.2}, Mode::eye));
}

TEST(Traits, FollowInputs) {
    EXPECT_FALSE(make_diffuse(gray(0.5))->traits().needs_uv);
    EXPECT_TRUE(make_diffuse(constant_texture(white))->traits().needs_uv);
    EXPECT_FALSE(make_diffuse(gray(0))->traits().smooth);
    EXPECT_FALSE(make_plastic(1.5, gray(0), white, false)->traits().smooth);
    EXPECT_FALSE(make_plastic(1.5, white, gray(0), false)->traits().delta);
    EXPECT_FALSE(make_dielectric(1.5, white, gray(0))->traits().transmissive);
    EXPECT_TRUE(make_bump_map(make_diffuse(white), constant_texture(white), 1)->traits().needs_tangents);
    EXPECT_TRUE(make_mask(make_diffuse(white), 0.5)->traits().transmissive);
    EXPECT_FALSE(make_mask(make_diffuse(white), 1)->traits().transmissive);
    EXPECT_TRUE(make_mask(make_diffuse(white), constant_texture(white))->traits().needs_uv);
    EXPECT_FALSE(make_blend(make_diffuse(white), make_diffuse(white), 1)->traits().chooses_lobe);
    EXPECT_STREQ(make_null()->name(), "null");
}

TEST(Dielectric, ScalesRadianceOnlyForTheEye) {
    const BsdfPtr glass = make_dielectric(1.5, white, white);
    for (const Vec3& w : {at_degrees(30), Vec3(-at_degrees(30))}) {
        const double eta = w.z() > 0 ? 1.5 : 1 / 1.5;
        const auto eye = glass->sample(flat_point(), w, 0.99, {0, 0}, Mode::eye);
        const auto light = glass->sample(flat_point(), w, 0.99, {0, 0}, Mode::light);
        ASSERT_TRUE(eye && light);
        EXPECT_LT(eye->w.z() * w.z(), 0);
        EXPECT_DOUBLE_EQ(eye->eta, eta);
        EXPECT_NEAR(eye->weight[0], 1 / (eta * eta), 1e-15);
        EXPECT_NEAR(light->weight[0], 1, 1e-15);
        EXPECT_NEAR(light->pdf, fresnel_dielectric(std::cos(pi / 6), eta).transmittance, 1e-15);
    }
}

TEST(Dielectric, OnlyReflectsBeyondTheCriticalAngle) {
    const BsdfPtr glass = make_dielectric(1.5, white, white);
    const Vec3 w = -at_degrees(45);
    for (const double u_lobe : {0.0, 0.5, one_minus_epsilon}) {
        const auto s = glass->sample(flat_point(), w, u_lobe, {0, 0}, Mode::eye);
        ASSERT_TRUE(s);
        EXPECT_EQ(s->w, reflect(w));
        EXPECT_EQ(s->pdf, 1);
        EXPECT_EQ(s->weight[0], 1);
    }
    EXPECT_FALSE(make_dielectric(1.5, gray(0), white)->sample(flat_point(), w, 0.5, {0, 0}, Mode::eye));
}

TEST(ThinDielectric, SumsTheReflectionsInside) {
    // R = 0.04 at normal incidence: 2 R / (1 + R).
    const auto s = make_thin_dielectric(1.5, white, white)->sample(flat_point(), {0, 0, 1}, 0, {0, 0}, Mode::eye);
    ASSERT_TRUE(s);
    EXPECT_DOUBLE_EQ(s->pdf, 0.08 / 1.04);
    EXPECT_EQ(s->w, Vec3(0, 0, 1));
}

TEST(Plastic, BaseIsSeenThroughTheCoat) {
    const double eta = 1.49, inside = fresnel_diffuse_reflectance(1 / eta);
    const Vec3 a = at_degrees(20), b = at_degrees(70, 2);
    const double coat = fresnel_dielectric(a.z(), eta).transmittance * fresnel_dielectric(b.z(), eta).transmittance;
    for (const bool nonlinear : {false, true}) {
        const Spectrum base(0.8, 0.5, 0.1);
        const BsdfValue v = make_plastic(eta, base, white, nonlinear)->eval(flat_point(), a, b);
        for (int i = 0; i < 3; ++i) {
            const double turns = 1 / (1 - (nonlinear ? base[i] : 1) * inside);
            EXPECT_NEAR(v.f[i], coat * base[i] * turns / (pi * eta * eta), 1e-14);
        }
    }
}

TEST(Phong, IsTheNormalisedPowerOfTheCosine) {
    const Vec3 a = at_degrees(30), b = at_degrees(50, 0.3 + pi);
    const double alpha = 20 * pi / 180;
    const BsdfValue v = make_phong(10, gray(0.2), gray(0.6))->eval(flat_point(), a, b);
    const double lobe = std::pow(std::cos(alpha), 10) / (2 * pi);
    EXPECT_NEAR(v.f[0], 0.2 / pi + 0.6 * 12 * lobe, 1e-14);
    EXPECT_NEAR(v.pdf_light, 0.25 * b.z() / pi + 0.75 * 11 * lobe, 1e-14);
    EXPECT_NEAR(v.pdf_eye, 0.25 * a.z() / pi + 0.75 * 11 * lobe, 1e-14);
}

TEST(Mask, PassesStraightOn) {
    const BsdfPtr mask = make_mask(make_diffuse(white), 0.25);
    const auto s = mask->sample(flat_point(), at_degrees(30), 0.7, {0.1, 0.2}, Mode::eye);
    ASSERT_TRUE(s);
    EXPECT_TRUE(s->delta);
    EXPECT_EQ(s->w, -at_degrees(30));
    EXPECT_EQ(s->pdf, 0.75);
    EXPECT_DOUBLE_EQ(mask->eval(flat_point(), at_degrees(30), at_degrees(40)).f[0], 0.25 / pi);
}

// A number inside a lobe's interval is handed on as its position there: u_lobe = 0.75 + 0.25 v meets the nested BSDF
// with v.
TEST(Mask, HandsTheLobeNumberOn) {
    const BsdfPtr nested = make_plastic(1.49, gray(0.5), white, true), mask = make_mask(nested, 0.25);
    for (const double v : {0.0, 0.01, 0.1, 0.5, 0.999}) {
        const auto inner = nested->sample(flat_point(), at_degrees(70), v, {0.1, 0.7}, Mode::eye);
        const auto outer = mask->sample(flat_point(), at_degrees(70), 0.75 + 0.25 * v, {0.1, 0.7}, Mode::eye);
        ASSERT_TRUE(inner && outer);
        EXPECT_EQ(outer->lobe, inner->lobe + 1);
        EXPECT_EQ(outer->w, inner->w);
        EXPECT_DOUBLE_EQ(outer->pdf, 0.25 * inner->pdf);
    }
}

TEST(Lobes, AreUniqueOverNestedBsdfs) {
    const BsdfPtr plastic = make_plastic(1.49, gray(0.5), white, true), phong = make_phong(20, gray(0.4), gray(0.4));
    EXPECT_THAT(lobes_seen(*make_blend(plastic, phong, 0.5)), ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(lobes_seen(*make_mask(make_blend(plastic, phong, 0.5), 0.5)), ElementsAre(0, 1, 2, 3, 4));
    EXPECT_THAT(lobes_seen(*make_blend(make_blend(phong, phong, 0.5), make_mask(phong, 0.5), 0.5)),
                ElementsAre(0, 1, 2, 3, 4, 5, 6));
    BsdfPtr deep = phong;
    for (int i = 0; i < 6; ++i) deep = make_blend(deep, deep, 0.5);  // 2 lobes times 64
    EXPECT_EQ(deep->traits().lobes, 128);
    EXPECT_THROW(make_blend(deep, deep, 0.5), std::invalid_argument);
}

TEST(TwoSided, RefusesTransmission) {
    const BsdfPtr lambert = make_diffuse(white), glass = make_dielectric(1.5, white, white);
    EXPECT_THROW(make_two_sided(lambert, glass), std::invalid_argument);
    EXPECT_THROW(make_two_sided(make_null(), lambert), std::invalid_argument);
    EXPECT_THROW(make_two_sided(make_mask(lambert, 0.5), lambert), std::invalid_argument);
}

TEST(TwoSided, BackIsTheMirrorImageOfTheFront) {
    const auto flip = [](const Vec3& w) { return Vec3(w.x(), w.y(), -w.z()); };
    const Vec3 a = at_degrees(20), b = at_degrees(30, 3);
    for (const BsdfPtr& nested : {make_phong(20, gray(0.4), gray(0.4)), make_diffuse(gray(0.4))}) {
        const BsdfPtr both = make_two_sided(nested, nested);
        EXPECT_STREQ(both->name(), "twosided");
        for (const bool below : {false, true}) {
            const auto turned = [&](const Vec3& w) { return below ? flip(w) : w; };
            const BsdfValue value = both->eval(flat_point(), turned(a), turned(b));
            const BsdfValue expected = nested->eval(flat_point(), a, b);
            EXPECT_EQ(value.f[0], expected.f[0]);
            EXPECT_EQ(value.pdf_light, expected.pdf_light);
            EXPECT_EQ(value.pdf_eye, expected.pdf_eye);
            EXPECT_EQ(both->eval(flat_point(), turned(a), turned(flip(b))).f[0], 0);
            const auto sample = both->sample(flat_point(), turned(a), 0.2, {0.6, 0.7}, Mode::light);
            const auto front = nested->sample(flat_point(), a, 0.2, {0.6, 0.7}, Mode::light);
            ASSERT_TRUE(front && sample);
            EXPECT_EQ(sample->w, turned(front->w));
            EXPECT_EQ(sample->pdf, front->pdf);
            EXPECT_EQ(sample->pdf_reverse, front->pdf_reverse);
        }
    }
}

TEST(BumpMap, FlatMapChangesNothing) {
    const BsdfPtr phong = make_phong(20, gray(0.4), gray(0.4));
    const BsdfPtr bump = make_bump_map(phong, constant_texture(gray(0.5)), 3);
    const Vec3 a = at_degrees(20), b = at_degrees(30, 3);
    EXPECT_DOUBLE_EQ(bump->eval(flat_point(), a, b).f[0], phong->eval(flat_point(), a, b).f[0]);
}

// Heights h(u, v) on a surface with dp/du = 2 s, dp/dv = 0.5 s + 1.5 t: the displaced surface is z = g . (x, y) with
// g . dp/du = scale dh/du and g . dp/dv = scale dh/dv, and its normal is (-g, 1).
TEST(BumpMap, MirrorTurnsAboutTheDisplacedNormal) {
    const Vec2 slope(0.3, -0.2);
    const double scale = 0.8, gx = scale * slope.x() / 2, gy = (scale * slope.y() - 0.5 * gx) / 1.5;
    const Vec3 normal = Vec3(-gx, -gy, 1).normalized(), known = at_degrees(30);
    const BsdfPtr bump = make_bump_map(make_conductor({}, white), constant_texture(white, slope), scale);
    const auto s = bump->sample(flat_point(), known, 0, {0, 0}, Mode::eye);
    ASSERT_TRUE(s);
    EXPECT_LT((s->w - reflect(known, normal)).norm(), 1e-14);
    SurfacePoint mirrored = flat_point();  // dp/dv the other way round: v and its slope change sign together
    mirrored.dv_s = -mirrored.dv_s;
    mirrored.dv_t = -mirrored.dv_t;
    const BsdfPtr mirrored_bump =
        make_bump_map(make_conductor({}, white), constant_texture(white, {slope.x(), -slope.y()}), scale);
    const auto m = mirrored_bump->sample(mirrored, known, 0, {0, 0}, Mode::eye);
    ASSERT_TRUE(m);
    EXPECT_LT((m->w - s->w).norm(), 1e-14);
}

// f |cos(w_light)| is the nested one in the displaced frame, so a white diffuse surface keeps f |cos| = |n' . w| / pi.
TEST(BumpMap, CosineOfTheLightIsTheDisplacedOne) {
    const double gx = 0.4 * 0.5;
    const Vec3 normal = Vec3(-gx, 0, 1).normalized(), eye = at_degrees(10), light = at_degrees(40);
    SurfacePoint x = flat_point();
    x.dv_s = 0;
    const BsdfPtr bump = make_bump_map(make_diffuse(white), constant_texture(white, {0.4, 0}), 1);
    EXPECT_NEAR(bump->eval(x, eye, light).f[0] * light.z(), normal.dot(light) / pi, 1e-15);
    // A light above the horizon of the surface but below the displaced one gives nothing, and so the other way round.
    const Vec3 low(0.999, 0, std::sqrt(1 - 0.999 * 0.999)), below(-0.999, 0, -low.z());
    EXPECT_EQ(bump->eval(x, eye, low).f[0], 0);
    EXPECT_EQ(bump->eval(x, eye, below).f[0], 0);
}

// A mirror's coefficient as a measure: f = c delta(w_light - R(w_eye)) / |cos(w_light)| integrates over w_eye to
// c |cos(w_eye)| / |cos(w_light)|, because R keeps solid angles.
TEST(BumpMap, DeltaLobesHaveOneValueForBothEnds) {
    const BsdfPtr bump = make_bump_map(make_conductor({}, gray(0.7)), constant_texture(white, {0.5, 0.3}), 1);
    const Vec3 eye = at_degrees(35);
    const auto from_eye = bump->sample(flat_point(), eye, 0, {0, 0}, Mode::eye);
    ASSERT_TRUE(from_eye);
    const auto from_light = bump->sample(flat_point(), from_eye->w, 0, {0, 0}, Mode::light);
    ASSERT_TRUE(from_light);
    EXPECT_LT((from_light->w - eye).norm(), 1e-14);
    EXPECT_DOUBLE_EQ(from_eye->weight[0], 0.7);
    EXPECT_NEAR(from_light->weight[0], 0.7 * eye.z() / from_eye->w.z(), 1e-14);
}

}  // namespace
}  // namespace keyhole
