// Sensors: rays and views are inverses, and importance is the Jacobian of the raster position.
#include "scene/sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "base/frame.h"
#include "base/rng.h"

namespace keyhole {
namespace {

Affine posed() {
    Affine pose = Affine::Identity();
    pose.translate(Vec3(3, -2, 5)).rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized()));
    return pose;
}
Affine scaled(const Affine& transform, const Vec3& scale) {
    Affine result = transform;
    return result.scale(scale);
}

PerspectiveParams camera() {
    PerspectiveParams params;
    params.to_world = posed();
    params.width = 640;
    params.height = 360;
    params.fov = 55;
    params.principal_point_offset = {0.1, -0.05};
    return params;
}
PerspectiveParams lens() {
    PerspectiveParams params = camera();
    params.aperture_radius = 0.3;
    params.focus_distance = 4;
    return params;
}

std::unique_ptr<Sensor> make_pinhole() { return make_perspective_sensor(camera()); }
std::unique_ptr<Sensor> make_lens() { return make_thin_lens_sensor(lens()); }
std::unique_ptr<Sensor> make_orthographic() {
    OrthographicParams params;
    params.to_world = scaled(posed(), {2, 0.5, 3});
    params.width = 640;
    params.height = 360;
    return make_orthographic_sensor(params);
}

class SensorTest : public testing::TestWithParam<std::unique_ptr<Sensor> (*)()> {
  protected:
    std::unique_ptr<Sensor> sensor = GetParam()();
    Rng rng{7};

    Vec2 uniform2() {
        const double a = rng.uniform();
        return {a, rng.uniform()};
    }
    SensorPoint point() { return sensor->sample_point(uniform2()); }
    // Also outside the film.
    Vec2 raster() { return uniform2().cwiseProduct(Vec2(800, 500)) - Vec2(80, 70); }
};

TEST_P(SensorTest, InvertsItsPoint) {
    for (int i = 0; i < 2000; ++i) {
        const Vec2 u = uniform2(), unused = uniform2();
        const Vec2 inverse = sensor->invert_point(sensor->sample_point(u), unused);
        EXPECT_LE((inverse - (sensor->traits().aperture ? u : unused)).norm(), 1e-12);
    }
}

TEST_P(SensorTest, ViewInvertsRay) {
    for (int i = 0; i < 2000; ++i) {
        const SensorPoint e = point();
        const Vec2 position = raster();
        const SensorRay ray = sensor->ray(e, position);
        EXPECT_NEAR(ray.d.norm(), 1, 1e-14);
        const auto view = sensor->view(e, ray.o + ray.d * std::exp(8 * rng.uniform() - 3));
        ASSERT_TRUE(view);
        // Relative to the film's size.
        EXPECT_NEAR((view->raster - position).norm(), 0, 1e-12 * 640) << position.transpose();
        EXPECT_NEAR((view->o - ray.o).norm(), 0, 1e-12 * 10);
        const auto towards = sensor->raster_towards(e, ray.d);
        EXPECT_EQ(towards.has_value(), !sensor->traits().infinite);
        if (towards) {
            EXPECT_NEAR((*towards - position).norm(), 0, 1e-12 * 640) << position.transpose();
            EXPECT_FALSE(sensor->raster_towards(e, -ray.d));
        }
    }
}

// raster_per_measure against central differences. A step of 1e-4 leaves a relative error of order 1e-8 by the third
// derivative and of order 1e-12 by rounding.
TEST_P(SensorTest, RasterPerMeasureIsTheJacobian) {
    const double h = 1e-4;
    for (int i = 0; i < 200; ++i) {
        const SensorPoint e = point();
        const SensorRay ray = sensor->ray(e, raster());
        const Frame frame = Frame::from_normal(ray.d);
        const auto seen = [&](const Vec3& step) {
            const bool infinite = sensor->traits().infinite;
            const Vec3 x = infinite ? Vec3(ray.o + 3 * ray.d + step) : Vec3(e.p + 3 * (ray.d + step).normalized());
            return sensor->view(e, x)->raster;
        };
        const Vec2 ds = (seen(frame.s * h) - seen(-frame.s * h)) / (2 * h);
        const Vec2 dt = (seen(frame.t * h) - seen(-frame.t * h)) / (2 * h);
        const double jacobian = std::abs(ds.x() * dt.y() - ds.y() * dt.x());
        const auto view = sensor->view(e, ray.o + 3 * ray.d);
        EXPECT_NEAR(view->raster_per_measure / jacobian, 1, 1e-6);
        EXPECT_DOUBLE_EQ(view->importance, view->raster_per_measure * e.pdf);
    }
}

TEST_P(SensorTest, SeesOnlyBetweenTheClipPlanes) {
    const SensorPoint e = point();
    const SensorRay ray = sensor->ray(e, {320, 180});
    EXPECT_FALSE(sensor->view(e, ray.o - 1e-3 * ray.d));
    EXPECT_TRUE(sensor->view(e, ray.o + 1e-3 * ray.d));
    EXPECT_FALSE(sensor->view(e, ray.o - 10 * ray.d));
    EXPECT_TRUE(sensor->view(e, ray.o + 9000 * ray.d));
    EXPECT_FALSE(sensor->view(e, ray.o + 40000 * ray.d));
}

INSTANTIATE_TEST_SUITE_P(All, SensorTest, testing::Values(&make_pinhole, &make_lens, &make_orthographic),
                         [](const auto& made) { return std::string(made.param()->name()); });

// Mitsuba's conventions: +x of the camera is on the left of the image, +y up, raster y down.
TEST(Perspective, Orientation) {
    PerspectiveParams params;
    params.width = 200;
    params.height = 100;
    params.fov = 90;
    const auto sensor = make_perspective_sensor(params);
    const SensorPoint e = sensor->sample_point({0, 0});
    EXPECT_NEAR((sensor->view(e, {0, 0, 5})->raster - Vec2(100, 50)).norm(), 0, 1e-12);
    EXPECT_NEAR((sensor->view(e, {5, 0, 5})->raster - Vec2(0, 50)).norm(), 0, 1e-12);
    EXPECT_NEAR((sensor->view(e, {0, 2.5, 5})->raster - Vec2(100, 0)).norm(), 0, 1e-12);
    EXPECT_FALSE(sensor->view(e, {0, 0, -5}));
}

TEST(Perspective, FovAxes) {
    // Angle with the axis of the ray through `edge`.
    const auto half_fov = [](FovAxis axis, int width, int height, const Vec2& edge) {
        PerspectiveParams params;
        params.width = width;
        params.height = height;
        params.fov = 40;
        params.fov_axis = axis;
        const auto sensor = make_perspective_sensor(params);
        return std::acos(sensor->ray(sensor->sample_point({0, 0}), edge).d.z()) * 180 / pi;
    };
    EXPECT_NEAR(half_fov(FovAxis::x, 200, 100, {0, 50}), 20, 1e-10);
    EXPECT_NEAR(half_fov(FovAxis::y, 200, 100, {100, 0}), 20, 1e-10);
    EXPECT_NEAR(half_fov(FovAxis::diagonal, 200, 100, {200, 100}), 20, 1e-10);
    EXPECT_NEAR(half_fov(FovAxis::smaller, 200, 100, {100, 0}), 20, 1e-10);
    EXPECT_NEAR(half_fov(FovAxis::larger, 200, 100, {0, 50}), 20, 1e-10);
    EXPECT_NEAR(half_fov(FovAxis::smaller, 100, 200, {0, 100}), 20, 1e-10);
    EXPECT_NEAR(half_fov(FovAxis::larger, 100, 200, {50, 0}), 20, 1e-10);
}

TEST(Perspective, PrincipalPointMovesTheAxis) {
    PerspectiveParams params;
    params.width = 200;
    params.height = 100;
    params.principal_point_offset = {0.25, -0.1};
    const auto sensor = make_perspective_sensor(params);
    const auto view = sensor->view(sensor->sample_point({0, 0}), {0, 0, 1});
    EXPECT_NEAR((view->raster - Vec2(50, 60)).norm(), 0, 1e-12);
}

TEST(Perspective, IgnoresUniformScaleAndKeepsReflections) {
    PerspectiveParams params = camera();
    const auto plain = make_perspective_sensor(params);
    params.to_world = scaled(posed(), {7, 7, 7});
    const auto large = make_perspective_sensor(params);
    params.to_world = scaled(posed(), {-1, 1, 1});
    params.principal_point_offset.x() *= -1;
    const auto mirrored = make_perspective_sensor(params);
    const SensorPoint e = plain->sample_point({0, 0});
    const SensorRay ray = plain->ray(e, {100, 70});
    EXPECT_NEAR((large->ray(e, {100, 70}).d - ray.d).norm(), 0, 1e-14);
    EXPECT_NEAR((large->ray(e, {100, 70}).o - ray.o).norm(), 0, 1e-14);
    EXPECT_NEAR((mirrored->ray(e, {540, 70}).d - ray.d).norm(), 0, 1e-14);
}

TEST(Perspective, RefusesWhatItCannotBe) {
    PerspectiveParams params = camera();
    params.to_world = scaled(posed(), {1, 1, 1.1});
    EXPECT_THROW(make_perspective_sensor(params), std::invalid_argument);
    params.to_world = scaled(posed(), {0, 0, 0});
    EXPECT_THROW(make_perspective_sensor(params), std::invalid_argument);
    params.to_world = Affine::Identity();
    params.to_world.matrix()(0, 1) = 0.2;
    EXPECT_THROW(make_perspective_sensor(params), std::invalid_argument);
    params.to_world.matrix()(0, 1) = std::nan("");
    EXPECT_THROW(make_perspective_sensor(params), std::invalid_argument);
    params = camera();
    params.fov = 180;
    EXPECT_THROW(make_perspective_sensor(params), std::invalid_argument);
    params = camera();
    params.near_clip = params.far_clip;
    EXPECT_THROW(make_perspective_sensor(params), std::invalid_argument);
    EXPECT_THROW(make_thin_lens_sensor(camera()), std::invalid_argument);
}

TEST(ThinLens, FocusPlaneIsSharpAndNothingElse) {
    const auto sensor = make_lens(), pinhole = make_pinhole();
    const SensorPoint center = pinhole->sample_point({0, 0});
    const Vec3 d = pinhole->ray(center, {200, 100}).d, axis = posed().linear() * Vec3(0, 0, 1);
    const Vec3 focus = center.p + d * (4 / d.dot(axis)), behind = center.p + d * (6 / d.dot(axis));
    Rng rng(3);
    double spread = 0;
    for (int i = 0; i < 200; ++i) {
        const double u = rng.uniform();
        const SensorPoint e = sensor->sample_point({u, rng.uniform()});
        EXPECT_LE((e.p - center.p).norm(), 0.3 * (1 + 1e-12));
        EXPECT_NEAR((e.p - center.p).dot(axis), 0, 1e-14);
        EXPECT_NEAR(e.pdf, 1 / (pi * 0.09), 1e-12);
        EXPECT_NEAR((sensor->view(e, focus)->raster - Vec2(200, 100)).norm(), 0, 1e-10);
        spread = std::max(spread, (sensor->view(e, behind)->raster - Vec2(200, 100)).norm());
    }
    // Radius of the circle of confusion: pixels per unit length times 0.3 |1/4 - 1/6|.
    const double circle = 320 / std::tan(55 * pi / 360) * 0.3 / 12;
    EXPECT_LE(spread, circle * (1 + 1e-9));
    EXPECT_GE(spread, 0.9 * circle);
}

TEST(ThinLens, TendsToThePinhole) {
    PerspectiveParams params = lens();
    params.aperture_radius = 1e-9;
    const auto sensor = make_thin_lens_sensor(params), pinhole = make_pinhole();
    const Vec3 d = sensor->ray(sensor->sample_point({0.9, 0.2}), {10, 20}).d;
    EXPECT_NEAR((d - pinhole->ray(pinhole->sample_point({0, 0}), {10, 20}).d).norm(), 0, 1e-9);
}

TEST(Orthographic, SeesTheScaledSquare) {
    OrthographicParams params;
    params.to_world = scaled(Affine::Identity(), {3, 3, 1});
    params.width = 200;
    params.height = 100;
    const auto sensor = make_orthographic_sensor(params);
    const SensorPoint e = sensor->sample_point({0.3, 0.8});
    EXPECT_NEAR((e.p - Vec3(0, 0, -1)).norm(), 0, 1e-15);
    EXPECT_EQ(e.pdf, 1);
    EXPECT_NEAR((sensor->view(e, {3, 1.5, 7})->raster - Vec2(0, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((sensor->view(e, {-3, -1.5, 2})->raster - Vec2(200, 100)).norm(), 0, 1e-12);
    EXPECT_NEAR(sensor->view(e, {0, 0, 2})->importance, 200.0 * 100 / (6 * 3), 1e-10);
}

TEST(Orthographic, RefusesSingularTransforms) {
    OrthographicParams params;
    for (const Vec3& scale : {Vec3(1, 0, 1), Vec3(1, 1, 0), Vec3(0, 0, 0)}) {
        params.to_world = scaled(posed(), scale);
        EXPECT_THROW(make_orthographic_sensor(params), std::invalid_argument);
    }
}

}  // namespace
}  // namespace keyhole
