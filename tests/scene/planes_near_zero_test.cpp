// Rays that leave a plane do not hit it again, however near to zero its coordinate is: there the error of a point that
// was computed along a ray is not small beside the coordinates.
#include <gtest/gtest.h>

#include <cmath>

#include "small_scenes.h"

namespace keyhole {
namespace {

struct Case {
    std::string name;
    Affine to_world;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    const auto add = [&](const std::string& name, const Vec3& translation, double angle, const Vec3& axis) {
        all.push_back({name, Affine(Eigen::Translation3d(translation) * Eigen::AngleAxisd(angle, axis))});
    };
    // Sines and cosines of quarter turns are off by 1e-16, and so are the corners.
    add("floor", {0, 0, 0}, -pi / 2, Vec3::UnitX());
    add("wall", {0, 0.3, 0}, pi / 2, Vec3::UnitY());
    add("skew", {0, 0, 0}, 0.7, Vec3(1, -2, 0.5).normalized());
    for (const double z : {0.0, 1e-30, 1e-17, 1e-15, 1e-12, 1e-8, 1e-3, 1.0, 1e3})
        add("z_" + std::to_string(z > 0 ? -static_cast<int>(std::log10(z)) : 99), {0, 0, z}, 0, Vec3::UnitZ());
    return all;
}

// Shoots at points of the plane z = 0 under `to_world` and counts the rays and segments from and to points there, of
// both sides, that are blocked: there is nothing else.
int count_blocked(const Scene& scene, const Affine& to_world, Rng& rng) {
    int blocked = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 target = to_world * Vec3(1.9 * rng.uniform() - 0.95, 1.9 * rng.uniform() - 0.95, 0);
        const double scale = to_world.linear().norm();
        const Vec3 w = uniform_direction(rng);
        const auto x = scene.intersect(Ray{target + scale * w, -w});
        if (!x) continue;  // all but along the plane
        const Vec3 out = uniform_direction(rng);
        const Vec3 far = x->p + scale * out;
        blocked += scene.intersect(Scene::ray_from(*x, out)).has_value();
        blocked += !scene.unoccluded(segment(Scene::offset_origin(*x, out), far));
        blocked += !scene.unoccluded(segment(far, Scene::offset_target(*x, out, scale)));
    }
    return blocked;
}

TEST(PlanesNearZero, AreNotHitByRaysThatLeaveThem) {
    Rng rng(3);
    for (const Case& plane : cases()) {
        SceneBuilder builder;
        builder.add_rectangle(placed(plane.to_world));
        EXPECT_EQ(count_blocked(*build_with_sensor(builder), plane.to_world, rng), 0) << plane.name;
    }
}

// Two sheets in one plane but for the rounding of their corners: which of them is hit is not defined, but what leaves
// either is past both.
TEST(PlanesNearZero, MayHoldTwoSheets) {
    Rng rng(4);
    const Affine there(Eigen::AngleAxisd(pi / 2, Vec3::UnitX())), back(Eigen::AngleAxisd(-pi / 2, Vec3::UnitX()));
    for (const Case& plane : cases()) {
        for (const double scale : {1e-6, 1.0, 1e6}) {
            const Affine larger = plane.to_world * Affine(Eigen::UniformScaling<double>(scale));
            SceneBuilder builder;
            builder.add_rectangle(placed(larger));
            builder.add_rectangle(placed(larger * there * Affine(Eigen::Scaling(0.6, 0.4, 0.3)) * back));
            EXPECT_EQ(count_blocked(*build_with_sensor(builder), larger, rng), 0) << plane.name << " " << scale;
        }
    }
}

}  // namespace
}  // namespace keyhole
