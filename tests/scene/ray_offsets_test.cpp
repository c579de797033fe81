// Rays that leave a surface neither hit it again nor slip through a neighbour, at any scale and place.
//
// The shapes are convex, so that geometry says what a ray must do: outside, one that leaves never comes back; inside a
// closed box, every ray hits another face and any two points of different faces see each other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
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
        const double length = 3 * scene.radius();
        const Vec3 far = x.p + length * w;
        shadowed += !scene.unoccluded(segment(Scene::offset_origin(x, w), far)) +
                    !scene.unoccluded(segment(far, Scene::offset_target(x, w, length)));
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

// Whether a point of the cube [-1, 1]^3 lies at one of its edges, where rounding may leave it behind the other face.
bool at_edge(const Vec3& p) { return ((p.cwiseAbs().array() - 1).abs() < 1e-5).count() > 1; }

TEST(RayOffsets, NothingEscapesFromAClosedBox) {
    constexpr int rays = 1000000;
    for (const Placement& place : placements()) {
        SceneBuilder builder;
        builder.add_cube(placed(place.transform));
        const auto scene = build_with_sensor(builder);
        const Vec3 middle = place.transform.translation();
        const Affine to_cube = place.transform.inverse();
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
            const double length = (y.p - x.p).norm();
            const Vec3 a = Scene::offset_origin(x, w);
            const int hidden =
                !scene->unoccluded(segment(a, Scene::offset_target(y, -w, length))) +
                !scene->unoccluded(segment(Scene::offset_origin(y, -w), Scene::offset_target(x, w, length)));
            if (!at_edge(to_cube * x.p) && !at_edge(to_cube * y.p)) shadowed += hidden;
            const Vec3 behind = y.p + 1e-2 * scene->radius() * y.ng;  // outward
            unshadowed += scene->unoccluded(segment(a, behind));
            x = y;
        }
        EXPECT_EQ(same_face, 0) << place.name;
        EXPECT_EQ(shadowed, 0) << place.name;
        std::printf("%-16s escaped %d, through a wall %d of %d\n", place.name, escaped, unshadowed, rays);
        EXPECT_LE(escaped, rays / 20000) << place.name;
        EXPECT_LE(unshadowed, rays / 20000) << place.name;
    }
}

// A direction on the side of the unit vector n, its cosine between 1e-4 and 1, evenly in the logarithm.
Vec3 often_grazing_direction(const Vec3& n, Rng& rng) {
    const double cosine = std::pow(10, -4 * rng.uniform()), sine = std::sqrt(1 - cosine * cosine);
    const double phi = 2 * pi * rng.uniform();
    return Frame::from_normal(n).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
}

// Segments that end on a convex shape, from a tenth to a thousand times its radius away.
struct Targets {
    int shadowed = 0;
    double largest_share = 0;  // of the offset that was needed
};

Targets look_at_targets(const Scene& scene, const Vec3& middle, int segments, Rng& rng) {
    Targets result;
    for (int i = 0; i < segments; ++i) {
        const SurfacePoint x = random_point(scene, middle, false, rng);
        const Vec3 w = often_grazing_direction(x.ng, rng);
        const double length = scene.radius() * std::pow(10, -1 + 4 * rng.uniform());
        const Vec3 from = x.p + length * w, offset = Scene::offset_target(x, w, length) - x.p;
        const auto seen = [&](double share) { return scene.unoccluded(segment(from, x.p + share * offset)); };
        result.shadowed += !seen(1);
        if (seen(result.largest_share)) continue;
        double enough = 1;
        for (int step = 0; step < 10; ++step) {
            const double middle_share = (result.largest_share + enough) / 2;
            (seen(middle_share) ? enough : result.largest_share) = middle_share;
        }
    }
    return result;
}

TEST(RayOffsets, SegmentsEndBeforeTheirTarget) {
    for (const Placement& place : placements()) {
        const ShapeOptions options = placed(place.transform);
        Rng rng(5, 1);
        const auto check = [&](SceneBuilder& builder, const char* shape) {
            const auto scene = build_with_sensor(builder);
            EXPECT_EQ(look_at_targets(*scene, place.transform.translation(), 20000, rng).shadowed, 0)
                << shape << " " << place.name;
        };
        SceneBuilder cube, mesh, instance, sphere, disk;
        cube.add_cube(options);
        check(cube, "cube");
        mesh.add_mesh(octasphere(2, false), options);
        check(mesh, "mesh");
        instance.begin_group("ball");
        instance.add_mesh(octasphere(2, false), placed(similarity(0.4, 1, {0.1, 0.2, 0})));
        instance.end_group();
        instance.add_instance("ball", place.transform);
        check(instance, "instance");
        sphere.add_sphere({0, 0, 0}, 1, options);
        check(sphere, "sphere");
        disk.add_disk(options);
        check(disk, "disk");
    }
}

// The bound is a proof's worst case: that many roundings never all add up, but they come within a factor of ten.
TEST(RayOffsets, AreNotMuchLargerThanTheErrorsAtTheTarget) {
    double largest = 0;
    for (const Placement& place : placements()) {
        SceneBuilder plane;
        plane.add_rectangle(placed(place.transform));
        Rng rng(7, 1);
        const auto scene = build_with_sensor(plane);
        const Targets targets = look_at_targets(*scene, place.transform.translation(), 200000, rng);
        EXPECT_EQ(targets.shadowed, 0) << place.name;
        largest = std::max(largest, targets.largest_share);
    }
    std::printf("the largest error of a segment's end was %.3f of its bound\n", largest);
    EXPECT_GT(largest, 0.1);
    EXPECT_LT(largest, 0.25);
}

// Between the two skins of a box, a ten-thousandth of its size apart.
TEST(RayOffsets, NoLightPassesAWallCloseToTheTarget) {
    constexpr int segments = 100000;
    for (const Placement& place : placements()) {
        SceneBuilder builder;
        builder.add_cube(placed(place.transform));
        builder.add_cube(placed(place.transform * Affine(Eigen::UniformScaling<double>(1 - 1e-4))));
        const auto scene = build_with_sensor(builder);
        const Vec3 middle = place.transform.translation();
        Rng rng(6, 1);
        int lit = 0;
        for (int i = 0; i < segments; ++i) {
            SurfacePoint x = random_point(*scene, middle, true, rng);  // on the inner skin; seen from between both
            const Vec3 w = leaving_direction(x, false, rng);  // rays along the skins leave at the edges of the box
            const double length = scene->radius() * (2 + 8 * rng.uniform());
            lit += scene->unoccluded(segment(x.p + length * w, Scene::offset_target(x, w, length)));
        }
        std::printf("%-16s lit through the wall %d of %d\n", place.name, lit, segments);
        EXPECT_LE(lit, segments / 20000) << place.name;
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
