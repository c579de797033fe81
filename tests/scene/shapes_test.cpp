// Hits and samples of every shape, against what geometry says.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "small_scenes.h"
#include "statistics.h"

namespace keyhole {
namespace {

// One kind of shape under a transform, and what is known of it in its local space.
struct ShapeCase {
    std::string name;
    Affine to_world;
    std::function<void(SceneBuilder&, const ShapeOptions&)> add;
    std::function<double(const Vec3&)> distance;  // of a local point to the surface, to first order
    std::function<Vec3(const Vec3&)> normal;      // outward, at a local surface point
    std::function<Vec2(const Vec3&)> uniform;     // local surface point to [0,1)^2, uniform for uniform area
    double area;                                  // in world space
};

double cube_distance(const Vec3& p) { return std::abs(p.cwiseAbs().maxCoeff() - 1); }

Vec3 cube_normal(const Vec3& p) {
    int axis = 0;
    p.cwiseAbs().maxCoeff(&axis);
    Vec3 n(0, 0, 0);
    n[axis] = p[axis] > 0 ? 1 : -1;
    return n;
}

// The six faces side by side.
Vec2 cube_uniform(const Vec3& p) {
    int axis = 0;
    p.cwiseAbs().maxCoeff(&axis);
    const int face = 2 * axis + (p[axis] > 0);
    const double a = (p[(axis + 1) % 3] + 1) / 2, b = (p[(axis + 2) % 3] + 1) / 2;
    return {clamp01((face + clamp01(a)) / 6), clamp01(b)};
}

std::vector<ShapeCase> shape_cases() {
    const Affine place = similarity(0.8, 0.3, {3, -2, 5});
    Affine mirrored = similarity(2.1, 1.7, {-1, 4, 0.5});
    mirrored.linear().col(0) *= -1;
    Affine sheared = similarity(1.1, 0.9, {1, 1, -1});
    sheared.linear().col(1) += 0.7 * sheared.linear().col(0);
    const double sheared_area = sheared.linear().col(0).cross(sheared.linear().col(1)).norm();

    const auto rectangle = [](SceneBuilder& b, const ShapeOptions& o) { b.add_rectangle(o); };
    const auto plane_distance = [](const Vec3& p) { return std::abs(p.z()); };
    const auto up = [](const Vec3&) { return Vec3(0, 0, 1); };
    const auto square = [](const Vec3& p) { return Vec2(clamp01((p.x() + 1) / 2), clamp01((p.y() + 1) / 2)); };
    const auto disk_uniform = [](const Vec3& p) {
        return Vec2(clamp01(p.x() * p.x() + p.y() * p.y()), azimuth_to_unit(p.x(), p.y()));
    };
    const auto sphere_distance = [](const Vec3& p) { return std::abs(p.norm() - 1); };
    const auto radial = [](const Vec3& p) { return Vec3(p.normalized()); };
    const auto sphere_uniform = [](const Vec3& p) {
        return Vec2(clamp01((1 - p.z()) / 2), azimuth_to_unit(p.x(), p.y()));
    };
    const auto tube_distance = [](const Vec3& p) { return std::abs(std::hypot(p.x(), p.y()) - 0.5); };
    const auto tube_normal = [](const Vec3& p) { return Vec3(Vec3(p.x(), p.y(), 0).normalized()); };
    const auto tube_uniform = [](const Vec3& p) {
        return Vec2(clamp01((p.z() + 1) / 3), azimuth_to_unit(p.x(), p.y()));
    };
    const auto sphere = [](SceneBuilder& b, const ShapeOptions& o) { b.add_sphere({0, 0, 0}, 1, o); };
    const auto disk = [](SceneBuilder& b, const ShapeOptions& o) { b.add_disk(o); };
    const auto cylinder = [](SceneBuilder& b, const ShapeOptions& o) { b.add_cylinder({0, 0, -1}, {0, 0, 2}, 0.5, o); };
    const auto cube = [](SceneBuilder& b, const ShapeOptions& o) { b.add_cube(o); };
    const double s = 0.3 * 0.3, m = 1.7 * 1.7;
    return {
        {"rectangle", place, rectangle, plane_distance, up, square, 4 * s},
        {"rectangle_mirrored", mirrored, rectangle, plane_distance, up, square, 4 * m},
        {"rectangle_sheared", sheared, rectangle, plane_distance, up, square, 4 * sheared_area},
        {"cube", place, cube, cube_distance, cube_normal, cube_uniform, 24 * s},
        {"cube_mirrored", mirrored, cube, cube_distance, cube_normal, cube_uniform, 24 * m},
        {"sphere", place, sphere, sphere_distance, radial, sphere_uniform, 4 * pi * s},
        {"sphere_mirrored", mirrored, sphere, sphere_distance, radial, sphere_uniform, 4 * pi * m},
        {"disk", place, disk, plane_distance, up, disk_uniform, pi * s},
        {"disk_sheared", sheared, disk, plane_distance, up, disk_uniform, pi * sheared_area},
        {"cylinder", place, cylinder, tube_distance, tube_normal, tube_uniform, 3 * pi * s},
        {"cylinder_mirrored", mirrored, cylinder, tube_distance, tube_normal, tube_uniform, 3 * pi * m},
    };
}

class Shapes : public testing::TestWithParam<ShapeCase> {
  protected:
    std::unique_ptr<Scene> build(bool flip, bool emits) const {
        ShapeOptions options = placed(GetParam().to_world);
        options.flip_normals = flip;
        if (emits) options.radiance = ColorInput(Spectrum(1, 1, 1));
        SceneBuilder builder;
        GetParam().add(builder, options);
        return build_with_sensor(builder);
    }
    // A ray from near the shape towards it; some miss.
    static Ray random_ray(const Scene& scene, Rng& rng) {
        const Vec3 o = scene.center() + 2 * scene.radius() * uniform_direction(rng);
        const Vec3 target = scene.center() + 0.9 * scene.radius() * uniform_direction(rng) * rng.uniform();
        return {o, (target - o).normalized()};
    }
    Vec3 world_normal(const Vec3& p_local) const {
        return (GetParam().to_world.linear().inverse().transpose() * GetParam().normal(p_local)).normalized();
    }
};

// The position of a mesh's vertices is rounded to float: its surface is off the ideal one by this much, relative to
// the coordinates. Curved shapes are held to double precision.
double surface_tolerance(const std::string& name) {
    return name.starts_with("rectangle") || name.starts_with("cube") ? 4e-7 : 2e-15;
}

TEST_P(Shapes, HitIsOnTheSurfaceAndOnTheRay) {
    const auto scene = build(false, false);
    const Affine to_local = GetParam().to_world.inverse();
    const double scale = scene->center().norm() + scene->radius();
    const double local_scale = scale * to_local.linear().norm();
    Rng rng(1, 1);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Ray ray = random_ray(*scene, rng);
        SurfacePoint x;
        if (!scene->intersect(ray, x)) continue;
        ++hits;
        const Vec3 local = to_local * x.p;
        ASSERT_LE(GetParam().distance(local), surface_tolerance(GetParam().name) * local_scale);
        ASSERT_LE((x.p - ray.o).cross(ray.d).norm(), 4e-15 * scale);
        ASSERT_GT((x.p - ray.o).dot(ray.d), 0);
        ASSERT_LE((x.ng - world_normal(local)).norm(), 2 * surface_tolerance(GetParam().name) * local_scale + 4e-15);
        ASSERT_LE((x.frame.n - x.ng).norm(), 1e-15);
        ASSERT_NEAR(x.frame.s.cross(x.frame.t).dot(x.frame.n), 1, 1e-14);
        ASSERT_NE(x.bsdf, nullptr);
        ASSERT_EQ(x.emitter, nullptr);
    }
    EXPECT_GT(hits, 3000);
}

// Nothing nearer is skipped and nothing farther taken: points along the ray before the hit are off the surface, which
// for shapes that enclose a volume or bound a half-space shows as a constant sign.
TEST_P(Shapes, UnoccludedAgreesWithIntersect) {
    const auto scene = build(false, false);
    Rng rng(2, 1);
    for (int i = 0; i < 20000; ++i) {
        const Ray ray = random_ray(*scene, rng);
        SurfacePoint x;
        const bool hit = scene->intersect(ray, x);
        ASSERT_NE(hit, scene->unoccluded(ray));
        if (!hit) continue;
        const double t = (x.p - ray.o).norm();
        ASSERT_TRUE(scene->unoccluded(segment(ray.o, ray.o + 0.999 * t * ray.d)));
        ASSERT_FALSE(scene->unoccluded(segment(ray.o, ray.o + 1.001 * t * ray.d)));
        ASSERT_TRUE(scene->unoccluded({ray.o, ray.d, 0, 0.999 * t}));
    }
}

TEST_P(Shapes, FlippedNormalsPointTheOtherWay) {
    const auto scene = build(false, false), flipped = build(true, false);
    Rng rng(3, 1);
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        const Ray ray = random_ray(*scene, rng);
        SurfacePoint x, y;
        const bool hit = scene->intersect(ray, x);
        ASSERT_EQ(hit, flipped->intersect(ray, y));
        if (!hit) continue;
        ++hits;
        ASSERT_EQ(x.p, y.p);
        ASSERT_EQ(x.ng, -y.ng);
        ASSERT_EQ(x.frame.n, -y.frame.n);
    }
    EXPECT_GT(hits, 100);
}

TEST_P(Shapes, SamplesLieOnTheSurfaceWithItsNormal) {
    for (const bool flip : {false, true}) {
        const auto scene = build(flip, true);
        const Emitter& emitter = *scene->emitters()[0];
        const Affine to_local = GetParam().to_world.inverse();
        const double local_scale = (scene->center().norm() + scene->radius()) * to_local.linear().norm();
        const double tolerance = surface_tolerance(GetParam().name) * local_scale;
        Rng rng(4, 1);
        for (int i = 0; i < 2000; ++i) {
            const double part = rng.uniform();
            const EmitterPoint e = emitter.sample_point(part, uniform2(rng));
            const Vec3 local = to_local * e.p;
            ASSERT_LE(GetParam().distance(local), tolerance);
            ASSERT_LE((e.ng - (flip ? -1 : 1) * world_normal(local)).norm(), 2 * tolerance + 4e-15);
            // A ray towards the sample, against its normal, meets it (or, from inside, another part) there.
            SurfacePoint x;
            const double near = 1e-3 * scene->radius();
            ASSERT_TRUE(scene->intersect({e.p + near * e.ng, -e.ng, 0, 2 * near}, x));
            ASSERT_LE((x.p - e.p).norm(), 1e-14 * (e.p.norm() + scene->radius()));
            ASSERT_LE((x.ng - e.ng).norm(), 1e-12);
            ASSERT_EQ(x.emitter, &emitter);
        }
    }
}

// The maps are one to one but for where the primitive's number lies in its interval.
TEST_P(Shapes, InvertedSamplesGiveTheirNumbers) {
    const auto scene = build(false, true);
    const Emitter& emitter = *scene->emitters()[0];
    Rng rng(6, 1);
    for (int i = 0; i < 2000; ++i) {
        const double part = rng.uniform();
        const Vec2 u = uniform2(rng);
        const EmitterPoint e = emitter.sample_point(part, u);
        InverseNumbers v;
        v.place = rng.uniform();
        const auto n = emitter.invert_point(e, v);
        ASSERT_TRUE(n);
        ASSERT_LE((n->point - u).norm(), 1e-7) << u.transpose();
        ASSERT_EQ(emitter.sample_point(n->part, n->point).primitive, e.primitive);
    }
}

// False alarms: 1e-5 over all shapes.
TEST_P(Shapes, SamplesAreUniformInArea) {
    const auto scene = build(false, true);
    const Emitter& emitter = *scene->emitters()[0];
    const Affine to_local = GetParam().to_world.inverse();
    EXPECT_NEAR(1 / emitter.pdf_point({}), GetParam().area, 1e-6 * GetParam().area);
    constexpr int rows = 24, columns = 10, samples = 100000;
    std::vector<double> observed(rows * columns, 0), expected(rows * columns, samples / double(rows * columns));
    Rng rng(5, 1);
    for (int i = 0; i < samples; ++i) {
        const double part = rng.uniform();
        const Vec2 u = GetParam().uniform(to_local * emitter.sample_point(part, uniform2(rng)).p);
        ++observed[static_cast<std::size_t>(int(u.x() * rows) * columns + int(u.y() * columns))];
    }
    EXPECT_GT(chi_square_p_value(expected, observed), sidak_level(1e-5, 11));
}

INSTANTIATE_TEST_SUITE_P(All, Shapes, testing::ValuesIn(shape_cases()),
                         [](const auto& test) { return test.param.name; });

// A mesh whose vertices are not shared has known areas per triangle.
TEST(MeshShapes, TrianglesAreChosenByArea) {
    auto mesh = std::make_shared<Mesh>();
    const double areas[] = {1, 5, 0, 2, 0.01, 0};
    double total = 0;
    for (const double area : areas) {
        const float x = static_cast<float>(10 * mesh->triangles.size());
        const auto first = static_cast<std::uint32_t>(mesh->positions.size());
        mesh->positions.insert(mesh->positions.end(), {{x, 0, 0}, {x + 2, 0, 0}, {x, static_cast<float>(area), 0}});
        mesh->triangles.push_back({first, first + 1, first + 2});
        total += area;
    }
    ShapeOptions options;
    options.radiance = ColorInput(Spectrum(1, 1, 1));
    SceneBuilder builder;
    builder.add_mesh(mesh, options);
    const auto scene = build_with_sensor(builder);
    constexpr int samples = 100000;
    std::vector<double> observed(6, 0), expected;
    for (const double area : areas) expected.push_back(samples * area / total);
    Rng rng(6, 1);
    for (int i = 0; i < samples; ++i) {
        const double part = rng.uniform();
        const EmitterPoint e = scene->emitters()[0]->sample_point(part, uniform2(rng));
        ++observed[static_cast<std::size_t>(e.p.x() / 10)];
    }
    EXPECT_GT(chi_square_p_value(expected, observed), 1e-6);  // false alarms: 1e-6
    EXPECT_EQ(scene->emitters()[0]->sample_point(one_minus_epsilon, {0.5, 0.5}).ng, Vec3(0, 0, 1));
}

TEST(MeshShapes, ShadingNormalsAreInterpolatedAndDecideTheSide) {
    for (const bool flip : {false, true}) {
        for (const float side : {1.0F, -1.0F}) {
            const auto mesh = octasphere(3, true);
            for (Vec3f& n : mesh->normals) n *= side;
            ShapeOptions options = placed(similarity(0.4, 2, {1, 2, 3}));
            options.flip_normals = flip;
            SceneBuilder builder;
            builder.add_mesh(mesh, options);
            const auto scene = build_with_sensor(builder);
            Rng rng(7, 1);
            for (int i = 0; i < 2000; ++i) {
                const Vec3 d = uniform_direction(rng);
                SurfacePoint x;
                ASSERT_TRUE(scene->intersect({Vec3(1, 2, 3) + 5 * d, -d}, x));
                const Vec3 expected = (x.p - Vec3(1, 2, 3)).normalized() * (flip ? -side : side);
                ASSERT_LE((x.frame.n - expected).norm(), 1e-6);  // vertex normals are floats
                ASSERT_NEAR(x.frame.n.norm(), 1, 1e-15);
                ASSERT_GT(x.ng.dot(x.frame.n), 0.9);
                ASSERT_GT((x.ng - x.frame.n).norm(), 1e-6);  // the geometric normal is the facet's
            }
        }
    }
}

TEST(MeshShapes, FaceNormalsIgnoreVertexNormals) {
    ShapeOptions options;
    options.face_normals = true;
    SceneBuilder builder;
    builder.add_mesh(octasphere(1, true), options);
    const auto scene = build_with_sensor(builder);
    SurfacePoint x;
    ASSERT_TRUE(scene->intersect({{3, 2, 1}, Vec3(-3, -2, -1).normalized()}, x));
    EXPECT_EQ(x.frame.n, x.ng);
}

}  // namespace
}  // namespace keyhole
