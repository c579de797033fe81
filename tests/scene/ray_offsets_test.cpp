// Rays that leave a surface neither hit it again nor slip through a neighbour, at any scale and place.
//
// The shapes are convex, so that geometry says what a ray must do: outside, one that leaves never comes back; inside a
// closed box, every ray hits another face and any two points of different faces see each other.
#include <gtest/gtest.h>

#include <string>

#include "small_scenes.h"

namespace keyhole {
namespace {

struct Placement {
    const char* name;
    Affine transform;
};

std::vector<Placement> placements() {
    Affine moved = similarity(0.7, 1, {1e4, -2e4, 0.5e4});
    Affine small_moved = similarity(0.3, 1e-2, {30, 10, -50});
    return {
        {"at the origin", similarity(0, 1, {0, 0, 0})},
        {"rotated", similarity(0.7, 1, {0.2, 0.1, -0.3})},
        {"tiny", similarity(0.7, 1e-6, {2e-7, 1e-7, -3e-7})},
        {"huge", similarity(0.7, 1e6, {2e5, 1e5, -3e5})},
        {"far away", moved},
        {"small and away", small_moved},
    };
}

// A random point of the scene's only surface, drawn by shooting at its middle from outside or from within.
SurfacePoint random_point(const Scene& scene, const Vec3& middle, bool inside, Rng& rng) {
    SurfacePoint x;
    for (;;) {
        const Vec3 d = uniform_direction(rng);
        const Vec3 aim = middle + 0.4 * scene.radius() * uniform_direction(rng);
        if (scene.intersect(inside ? Ray{middle, d} : Ray{aim + 5 * scene.radius() * d, -d}, x)) return x;
    }
}

Vec3 leaving_direction(const SurfacePoint& x, bool inside, Rng& rng) {
    const Vec3 w = square_to_cosine_hemisphere(uniform2(rng));
    return Frame::from_normal(inside ? Vec3(-x.ng) : x.ng).to_world(w);
}

void expect_no_return(const Scene& scene, const Vec3& middle, const char* name) {
    constexpr int rays = 100000;
    Rng rng(1, 1);
    int returned = 0, shadowed = 0;
    for (int i = 0; i < rays; ++i) {
        const SurfacePoint x = random_point(scene, middle, false, rng);
        const Vec3 w = leaving_direction(x, false, rng);
        SurfacePoint y;
        returned += scene.intersect(Scene::ray_from(x, w), y);
        const Vec3 far = x.p + 3 * scene.radius() * w;
        shadowed +=
            !scene.unoccluded(Scene::offset_origin(x, w), far) + !scene.unoccluded(far, Scene::offset_origin(x, w));
    }
    EXPECT_EQ(returned, 0) << name;
    EXPECT_EQ(shadowed, 0) << name;
}

TEST(RayOffsets, RaysThatLeaveAConvexShapeDoNotComeBack) {
    for (const Placement& place : placements()) {
        const ShapeOptions options = placed(place.transform);
        const Vec3 middle = place.transform.translation();
        const auto check = [&](SceneBuilder& builder, const std::string& shape) {
            const auto scene = build_with_sensor(builder);
            expect_no_return(*scene, middle, (shape + " " + place.name).c_str());
        };
        SceneBuilder cube, mesh, sphere, disk;
        cube.add_cube(options);
        check(cube, "cube");
        mesh.add_mesh(octasphere(2, false), options);
        check(mesh, "mesh");
        sphere.add_sphere({0, 0, 0}, 1, options);
        check(sphere, "sphere");
        disk.add_disk(options);
        check(disk, "disk");
    }
}

TEST(RayOffsets, NothingEscapesFromAClosedBox) {
    constexpr int rays = 200000;
    for (const Placement& place : placements()) {
        SceneBuilder builder;
        builder.add_cube(placed(place.transform));
        const auto scene = build_with_sensor(builder);
        const Vec3 middle = place.transform.translation();
        Rng rng(2, 1);
        int escaped = 0, same_face = 0, shadowed = 0, unshadowed = 0;
        SurfacePoint x = random_point(*scene, middle, true, rng);
        for (int i = 0; i < rays; ++i) {
            const Vec3 w = leaving_direction(x, true, rng);
            SurfacePoint y;
            if (!scene->intersect(Scene::ray_from(x, w), y)) {
                ++escaped;
                x = random_point(*scene, middle, true, rng);
                continue;
            }
            same_face += y.ng.dot(x.ng) > 0.9;
            const Vec3 a = Scene::offset_origin(x, w), b = Scene::offset_origin(y, -w);
            shadowed += !scene->unoccluded(a, b) || !scene->unoccluded(b, a);
            const Vec3 behind = y.p + 1e-2 * scene->radius() * y.ng;  // outward
            unshadowed += scene->unoccluded(a, behind);
            x = y;
        }
        EXPECT_EQ(same_face, 0) << place.name;
        EXPECT_EQ(shadowed, 0) << place.name;
        std::printf("%-16s escaped %d, through a wall %d of %d\n", place.name, escaped, unshadowed, rays);
        EXPECT_LE(escaped, rays / 20000) << place.name;
        EXPECT_LE(unshadowed, rays / 20000) << place.name;
    }
}

// The offset only has to cover float errors: it stays far below what can be seen.
TEST(RayOffsets, AreSmallBesideTheCoordinates) {
    for (const Placement& place : placements()) {
        SceneBuilder builder;
        builder.add_mesh(octasphere(3, false), placed(place.transform));
        const auto scene = build_with_sensor(builder);
        const double coordinates = scene->center().cwiseAbs().maxCoeff() + scene->radius();
        Rng rng(3, 1);
        double largest = 0;
        for (int i = 0; i < 1000; ++i) {
            const SurfacePoint x = random_point(*scene, place.transform.translation(), false, rng);
            ASSERT_GT(x.offset, 0);
            largest = std::max(largest, static_cast<double>(x.offset));
        }
        EXPECT_LT(largest, 1e-5 * coordinates) << place.name;
    }
}

// A tilted floor through the origin: the float error there follows the extent of the triangle, not the coordinates.
TEST(RayOffsets, HoldAtTheOriginOfALargeTiltedPlane) {
    for (const double angle : {0.3, 1.0, 2.4}) {
        SceneBuilder builder;
        builder.add_rectangle(placed(similarity(angle, 1e3, {0, 0, 0})));
        const auto scene = build_with_sensor(builder);
        const Vec3 n = similarity(angle, 1, {0, 0, 0}).linear() * Vec3(0, 0, 1);
        Rng rng(4, 1);
        for (int i = 0; i < 100000; ++i) {
            const Vec3 o = 1e-2 * (n + 0.5 * uniform_direction(rng));
            SurfacePoint x, y;
            ASSERT_TRUE(scene->intersect({o, -n}, x));
            ASSERT_FALSE(scene->intersect(Scene::ray_from(x, leaving_direction(x, false, rng)), y));
        }
    }
}

}  // namespace
}  // namespace keyhole
