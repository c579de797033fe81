// Shapes seen through instances are the shapes that a baked transform gives.
#include <gtest/gtest.h>

#include "small_scenes.h"

namespace keyhole {
namespace {

// Values that floats hold exactly, so that both ways have the same surface but for the rounding of baked positions.
Affine exact_transform(const Vec3& translation) {
    Affine m;
    m.linear() << 0, -1.5, 0, 2, 0, 0, 0, 0.25, 0.75;
    m.translation() = translation;
    return m;
}

ShapeOptions with_id(const Affine& to_world, bool flip) {
    ShapeOptions options = placed(to_world);
    options.flip_normals = flip;
    return options;
}

// `tolerance` is of positions, relative to the scene.
void expect_same_surfaces(const Scene& a, const Scene& b, double tolerance, double normal_tolerance = 1e-5) {
    // The box of an instance is the box of its group's transformed box: it holds the shapes, but not tightly.
    ASSERT_GE(a.radius(), b.radius() * (1 - 1e-6));
    ASSERT_LE(a.radius(), b.radius() * std::sqrt(3.0));
    Rng rng(1, 1);
    int hits = 0, differ = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 o = b.center() + 2 * b.radius() * uniform_direction(rng);
        const Vec3 d = (b.center() + 0.7 * b.radius() * uniform_direction(rng) - o).normalized();
        SurfacePoint x, y;
        const bool hit = a.intersect({o, d}, x);
        if (hit != b.intersect({o, d}, y)) {
            ++differ;
            continue;
        }
        if (!hit) continue;
        ++hits;
        if ((x.p - y.p).norm() > 1e-3 * a.radius()) {  // one side of an edge or the other
            ++differ;
            continue;
        }
        ASSERT_LE((x.p - a.center()).norm(), a.radius() * (1 + 1e-6));
        ASSERT_LE((x.p - y.p).norm(), tolerance * (o.norm() + a.radius()));
        ASSERT_LE((x.ng - y.ng).norm(), normal_tolerance);
        ASSERT_LE((x.frame.n - y.frame.n).norm(), normal_tolerance);
        ASSERT_LE((x.p - o).cross(d).norm(), 1e-14 * (o.norm() + a.radius()));
    }
    EXPECT_GT(hits, 3000);
    EXPECT_LE(differ, 20);
}

TEST(Instances, OfAGroupEqualBakedShapes) {
    const Affine local = similarity(0.5, 1, {0.5, 0, 0});
    const Vec3 places[] = {{0, 0, 0}, {6, 1, 0}, {-3, 7, 2}};
    SceneBuilder instanced, baked;
    instanced.begin_group("things");
    instanced.add_mesh(octasphere(2, true), with_id(local, false));
    instanced.add_cube(with_id(exact_transform({0, 0, 2}), true));
    instanced.end_group();
    for (const Vec3& place : places) {
        const Affine m = exact_transform(place);
        instanced.add_instance("things", m);
        baked.add_mesh(octasphere(2, true), with_id(m * local, false));
        baked.add_cube(with_id(m * exact_transform({0, 0, 2}), true));
    }
    const auto a = build_with_sensor(instanced), b = build_with_sensor(baked);
    expect_same_surfaces(*a, *b, 1e-5);
    EXPECT_EQ(a->statistics().instances, 3U);
    EXPECT_EQ(a->statistics().triangles, b->statistics().triangles);
    EXPECT_EQ(a->statistics().unique_triangles, 128U + 12U);
}

TEST(Instances, OfAnalyticShapesEqualBakedOnes) {
    const Affine m = similarity(1.3, 2, {4, -1, 2});
    SceneBuilder instanced, baked;
    instanced.begin_group("round");
    const auto add = [](SceneBuilder& builder, const Affine& to_world) {
        builder.add_sphere({0, 0, 1}, 0.5, placed(to_world));
        builder.add_disk(placed(to_world));
        builder.add_cylinder({1, 1, 0}, {1, 2, 1}, 0.2, placed(to_world));
    };
    add(instanced, Affine::Identity());
    instanced.end_group();
    instanced.add_instance("round", m);
    add(baked, m.cast<float>().cast<double>());
    const auto a = build_with_sensor(instanced), b = build_with_sensor(baked);
    expect_same_surfaces(*a, *b, 1e-14);
}

TEST(Instances, UnderANonUniformScaleMakeEllipsoids) {
    SceneBuilder builder;
    builder.begin_group("ball");
    builder.add_sphere({0, 0, 0}, 1, {});
    builder.end_group();
    const Vec3 axes(1, 2, 0.5);
    builder.add_instance("ball", Affine(Eigen::Scaling(axes)));
    const auto scene = build_with_sensor(builder);
    Rng rng(2, 1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 d = uniform_direction(rng);
        SurfacePoint x, y;
        ASSERT_TRUE(scene->intersect({5 * d, -d}, x));
        const Vec3 q = x.p.cwiseQuotient(axes);
        ASSERT_NEAR(q.norm(), 1, 1e-14);
        ASSERT_LE((x.ng - q.cwiseQuotient(axes).normalized()).norm(), 1e-13);
        ASSERT_FALSE(scene->intersect(Scene::ray_from(x, d), y));
    }
}

TEST(Instances, HaveNoSelfHits) {
    const Affine transforms[] = {similarity(0.7, 1, {0, 0, 0}), similarity(0.7, 1e-6, {2e-6, 1e-6, 0}),
                                 similarity(0.7, 1e6, {2e5, 1e5, 0}), similarity(0.7, 1, {1e4, 2e4, 0}),
                                 exact_transform({100, -50, 20})};
    for (const Affine& transform : transforms) {
        SceneBuilder builder;
        builder.begin_group("ball");
        builder.add_mesh(octasphere(2, false), placed(similarity(0.2, 1, {3, 1, -2})));
        builder.end_group();
        builder.add_instance("ball", transform);
        const auto scene = build_with_sensor(builder);
        Rng rng(3, 1);
        int returned = 0, shadowed = 0;
        for (int i = 0; i < 100000; ++i) {
            const Vec3 d = uniform_direction(rng);
            SurfacePoint x, y;
            if (!scene->intersect({scene->center() + 3 * scene->radius() * d, -d}, x)) continue;
            const Vec3 w = Frame::from_normal(x.ng).to_world(square_to_cosine_hemisphere(uniform2(rng)));
            returned += scene->intersect(Scene::ray_from(x, w), y);
            const double length = 4 * scene->radius();
            shadowed += !scene->unoccluded(segment(x.p + length * w, Scene::offset_target(x, w, length)));
        }
        EXPECT_EQ(returned, 0) << transform.matrix();
        EXPECT_EQ(shadowed, 0) << transform.matrix();
    }
}

// A grid of 2 n^2 triangles over [-1,1]^2.
std::shared_ptr<Mesh> grid(std::uint32_t n) {
    auto mesh = std::make_shared<Mesh>();
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const float x = 2 * static_cast<float>(i) / static_cast<float>(n) - 1;
            const float y = 2 * static_cast<float>(j) / static_cast<float>(n) - 1;
            mesh->positions.emplace_back(x, y, 0.3F * std::sin(3 * x) * std::cos(2 * y));
            if (i == n || j == n) continue;
            const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
            mesh->triangles.push_back({a, a + 1, b});
            mesh->triangles.push_back({a + 1, b + 1, b});
        }
    }
    return mesh;
}

TEST(Instances, ShareAMeshOnlyWhereThatSavesMuchMemory) {
    const std::shared_ptr<const Mesh> large = grid(350), small = grid(10);
    const BsdfPtr bsdfs[] = {make_diffuse(Spectrum(0.1, 0.1, 0.1)), make_null()};
    const auto build = [&](int uses, bool same_pointer, const std::shared_ptr<const Mesh>& mesh) {
        SceneBuilder builder;
        for (int i = 0; i < uses; ++i) {
            ShapeOptions options = placed(exact_transform(Vec3(4.0 * i, 0, 0.5 * i)));
            options.flip_normals = i == 1;
            options.bsdf = bsdfs[i % 2];
            builder.add_mesh(same_pointer ? mesh : std::make_shared<Mesh>(*mesh), options);
        }
        return build_with_sensor(builder);
    };
    const auto shared = build(4, true, large), baked = build(4, false, large);
    EXPECT_EQ(shared->statistics().instances, 4U);
    EXPECT_EQ(baked->statistics().instances, 0U);
    const auto bytes = [](const Scene& s) { return s.statistics().embree_bytes + s.statistics().mesh_bytes; };
    // As much as the builder wants to save; the copies of the mesh that `baked` was given do not count.
    EXPECT_LT(bytes(*shared) + (std::size_t{64} << 20), bytes(*baked) - 3 * large->bytes());
    // Baked corners (coordinates below 16) are off by 2^-20, edges by twice that; altitudes are above 2e-3.
    expect_same_surfaces(*shared, *baked, 1e-5, 1e-3);
    SurfacePoint x;
    ASSERT_TRUE(shared->intersect({{4, 0, 50}, {0, 0, -1}}, x));
    EXPECT_EQ(x.bsdf, bsdfs[1].get());

    EXPECT_EQ(build(1, true, large)->statistics().instances, 0U);
    EXPECT_EQ(build(4, true, small)->statistics().instances, 0U);
}

}  // namespace
}  // namespace keyhole
