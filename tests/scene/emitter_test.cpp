// What every emitter has to do, and what is particular to each but the environment map.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "base/frame.h"
#include "base/rng.h"
#include "emitter_checks.h"
#include "scene/emitters.h"
#include "scene/shape.h"

namespace keyhole {
namespace {

const Vec3 center(1, -2, 3);
const double radius = 2.5;
const Spectrum color(1, 2, 0.5);

// A rectangle of area 6 in the plane z = 1 that emits downwards; u_part chooses its half.
class Rectangle final : public Shape {
  public:
    double fill(const Ray&, const ShapeHit&, SurfacePoint&) const override { return 0; }
    double area() const override { return 6; }
    ShapeSample sample(double u_part, const Vec2& u) const override {
        const double x = (u.x() + (u_part < 0.5 ? 0 : 1)) / 2;
        return {{3 * x, 2 * u.y(), 1}, {0, 0, -1}, {x, u.y()}, 0.125f};
    }
    EmitterNumbers invert_sample(std::uint32_t, const Vec3& p, const InverseNumbers& v) const override {
        const double x = p.x() / 3, half = x < 0.5 ? 0 : 0.5;
        return {number_in_interval(v.place, half, half + 0.5), {2 * (x - half), p.y() / 2}};
    }
};
const Rectangle rectangle;

Affine pose() {
    Affine result = Affine::Identity();
    result.translate(Vec3(3, -2, 5)).rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized())).scale(3);
    return result;
}

std::unique_ptr<Emitter> make_area() { return make_area_emitter(rectangle, color); }
std::unique_ptr<Emitter> make_textured_area() {
    std::shared_ptr<const Texture> squares = make_checkerboard(color, {0, 0, 0}, Eigen::Matrix3d::Identity());
    return make_area_emitter(rectangle, squares);
}
std::unique_ptr<Emitter> make_point() { return make_point_emitter({3, 2, 1}, color); }
std::unique_ptr<Emitter> make_spot() { return make_spot_emitter(pose(), color, 50, 20); }
std::unique_ptr<Emitter> make_narrow_spot() { return make_spot_emitter(pose(), color, 0.5, 0.5); }
std::unique_ptr<Emitter> make_wide_spot() { return make_spot_emitter(pose(), color, 180, 0); }
std::unique_ptr<Emitter> make_directional() { return make_directional_emitter({-1, 3, 2}, color); }
std::unique_ptr<Emitter> make_constant() { return make_constant_emitter(color); }

class EmitterTest : public testing::TestWithParam<std::unique_ptr<Emitter> (*)()> {
  protected:
    EmitterTest() : emitter(GetParam()()) { emitter->set_scene_bounds(center, radius); }
    std::unique_ptr<Emitter> emitter;
};

TEST_P(EmitterTest, SamplesCarryTheirDensities) { EXPECT_TRUE(samples_carry_their_densities(*emitter)); }
TEST_P(EmitterTest, SurvivesTheEndsOfTheUnitInterval) { EXPECT_TRUE(survives_the_ends_of_the_unit_interval(*emitter)); }
TEST_P(EmitterTest, RaysFollowTheirDensity) { EXPECT_TRUE(rays_follow_their_density(*emitter, center, radius)); }
TEST_P(EmitterTest, InverseGivesTheSample) { EXPECT_TRUE(inverse_gives_the_sample(*emitter)); }
TEST_P(EmitterTest, InverseNumbersAreUniform) { EXPECT_TRUE(inverse_numbers_are_uniform(*emitter)); }
TEST_P(EmitterTest, PowerIsTheIntegralOfWhatIsEmitted) { EXPECT_TRUE(power_is_the_integral(*emitter)); }

INSTANTIATE_TEST_SUITE_P(All, EmitterTest,
                         testing::Values(&make_area, &make_textured_area, &make_point, &make_spot, &make_narrow_spot,
                                         &make_wide_spot, &make_directional, &make_constant));

TEST(AreaEmitter, PointsAreTheShapesSamples) {
    const auto emitter = make_area();
    const EmitterPoint e = emitter->sample_point(0.7, {0.5, 0.25});
    EXPECT_EQ(e.p, Vec3(2.25, 0.5, 1));
    EXPECT_EQ(e.ng, Vec3(0, 0, -1));
    EXPECT_EQ(e.uv, Vec2(0.75, 0.25));
    EXPECT_EQ(e.offset, 0.125f);
    EXPECT_DOUBLE_EQ(e.pdf, 1.0 / 6);
    EXPECT_TRUE(emitter->traits().surface && !emitter->traits().delta && !emitter->traits().infinite);
}

TEST(AreaEmitter, EmitsToTheSideOfItsNormal) {
    const auto emitter = make_area();
    const EmitterPoint e = emitter->sample_point(0.2, {0.5, 0.5});
    const Vec3 front = Vec3(0.6, 0, -0.8), back(0.6, 0, 0.8), along(1, 0, 0);
    EXPECT_TRUE((emitter->radiance(e, front) == color).all());
    EXPECT_LE((emitter->emitted(e, front) - 0.8 * color).abs().maxCoeff(), 1e-15);
    for (const Vec3& w : {back, along}) {
        EXPECT_TRUE((emitter->radiance(e, w) == 0).all());
        EXPECT_TRUE((emitter->emitted(e, w) == 0).all());
        EXPECT_EQ(emitter->pdf_ray(e, w), 0);
    }
    EXPECT_NEAR(emitter->pdf_ray(e, front), 0.8 / pi, 1e-15);
}

TEST(AreaEmitter, TakesTexturedRadianceFromTheParameters) {
    const auto emitter = make_textured_area();
    EXPECT_TRUE((emitter->radiance(emitter->sample_point(0.1, {0.2, 0.9}), {0, 0, -1}) == color).all());
    EXPECT_TRUE((emitter->radiance(emitter->sample_point(0.1, {0.2, 0.2}), {0, 0, -1}) == 0).all());
}

// Constant within the beam, then linear in the angle down to zero at the cutoff.
TEST(SpotEmitter, FallsOffLinearlyInAngle) {
    const auto emitter = make_spot();
    const EmitterPoint e = emitter->sample_point(0, {0, 0});
    const auto at = [&](double degrees) {
        const double angle = degrees * pi / 180;
        const Vec3 local(std::sin(angle) * 0.6, std::sin(angle) * 0.8, std::cos(angle));
        return emitter->emitted(e, (pose().linear() * local).normalized())[1];
    };
    for (const auto& [degrees, share] : {std::pair{0.0, 1.0}, {19.9, 1}, {35, 0.5}, {44, 0.2}, {50.1, 0}, {170, 0}})
        EXPECT_NEAR(at(degrees), 2 * share, 1e-12) << degrees;
    EXPECT_NEAR((e.p - Vec3(3, -2, 5)).norm(), 0, 1e-15);
}

TEST(SpotEmitter, PowerOfNarrowBeamsIsThatOfTheSmallCone) {
    const double angle = 1e-6 * pi / 180;
    const Spectrum power = make_spot_emitter(pose(), color, 1e-6, 1e-6)->power();
    EXPECT_NEAR(power[0] / (pi * angle * angle), 1, 1e-9);
    EXPECT_NEAR(make_spot_emitter(pose(), color, 1e-6, 0)->power()[0] / (pi * angle * angle / 3), 1, 1e-9);
}

TEST(InfiniteEmitters, EndpointsAreDirectionsTowardsTheEmitter) {
    const auto directional = make_directional();
    const EmitterPoint e = directional->sample_point(0, {0, 0});
    EXPECT_NEAR((e.p + Vec3(-1, 3, 2).normalized()).norm(), 0, 1e-15);
    EXPECT_TRUE(directional->traits().infinite && directional->traits().delta && !directional->traits().environment);
    const auto constant = make_constant();
    EXPECT_TRUE(constant->traits().infinite && constant->traits().environment && !constant->traits().delta);
    EXPECT_TRUE((constant->radiance({Vec3(0, 1, 0), Vec3::Zero()}, {0, -1, 0}) == color).all());
    EXPECT_NEAR(constant->pdf_point(e), 1 / (4 * pi), 1e-15);
}

TEST(InfiniteEmitters, ASceneWithoutExtentIsNoDivisionByZero) {
    const auto emitter = make_constant();
    emitter->set_scene_bounds({0, 0, 0}, 0);
    EXPECT_TRUE(std::isfinite(emitter->pdf_ray(emitter->sample_point(0, {0, 0}), {0, 1, 0})));
    EXPECT_GT(emitter->power()[0], 0);
}

TEST(Emitters, RefuseWhatTheyCannotBe) {
    Affine flat = Affine::Identity();
    flat.scale(Vec3(1, 1, 0));
    EXPECT_THROW(make_spot_emitter(flat, color, 20, 10), std::invalid_argument);
    EXPECT_THROW(make_spot_emitter(pose(), color, 0, 0), std::invalid_argument);
    EXPECT_THROW(make_spot_emitter(pose(), color, 181, 10), std::invalid_argument);
    EXPECT_THROW(make_spot_emitter(pose(), color, 20, 21), std::invalid_argument);
    EXPECT_THROW(make_directional_emitter({0, 0, 0}, color), std::invalid_argument);
}

}  // namespace
}  // namespace keyhole
