// What a scene is made of: emitters and their choice, bounds, requirements, statistics, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "small_scenes.h"
#include "statistics.h"

namespace keyhole {
namespace {

using testing::HasSubstr;

template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "not refused";
}

std::unique_ptr<Emitter> point(double intensity) {
    return make_point_emitter({0, 0, 3}, Spectrum(intensity, intensity, intensity));
}

// False alarms: 1e-6.
TEST(EmitterChoice, IsByPower) {
    SceneBuilder builder;
    const double powers[] = {0, 1, 5, 0, 2.5, 0.01, 0};
    for (const double power : powers) builder.add_emitter(point(power));
    const auto scene = build_with_sensor(builder);
    ASSERT_EQ(scene->emitters().size(), 7U);
    constexpr int samples = 200000;
    std::vector<double> observed(7, 0), expected;
    for (std::uint32_t i = 0; i < 7; ++i) {
        const Emitter* emitter = scene->emitters()[i];
        EXPECT_EQ(emitter->index(), i);
        EXPECT_NEAR(scene->emitter_probability(emitter), powers[i] / 8.51, 1e-15);
        expected.push_back(samples * scene->emitter_probability(emitter));
    }
    Rng rng(1, 1);
    for (int i = 0; i < samples; ++i) ++observed[scene->choose_emitter(rng.uniform())];
    EXPECT_GT(chi_square_p_value(expected, observed), 1e-6);
    EXPECT_EQ(scene->choose_emitter(0), 1U);
    EXPECT_EQ(scene->choose_emitter(one_minus_epsilon), 5U);
}

// Each has an interval of numbers of its own, down to powers of 1e-9 of the largest; its inverse stays within.
TEST(EmitterChoice, AmongAMillion) {
    SceneBuilder builder;
    constexpr std::uint32_t lights = 1000000;
    for (std::uint32_t i = 0; i < lights; ++i) builder.add_emitter(point(i % 1000 == 7 ? 1e-9 : 1 + i % 10));
    const auto scene = build_with_sensor(builder);
    double sum = 0;
    for (const Emitter* emitter : scene->emitters()) {
        sum += emitter->selection_probability();
        for (const double place : {0.0, 0.37, one_minus_epsilon}) {
            const double u = scene->invert_choice(*emitter, place);
            ASSERT_TRUE(u >= 0 && u < 1) << u;
            ASSERT_EQ(scene->choose_emitter(u), emitter->index()) << "at " << place;
        }
    }
    EXPECT_NEAR(sum, 1, 1e-9);
}

TEST(EmitterChoice, OfOneAndOfBlackEmitters) {
    SceneBuilder one, black;
    one.add_emitter(point(3));
    const auto single = build_with_sensor(one);
    EXPECT_EQ(single->choose_emitter(0.7), 0U);
    EXPECT_EQ(single->emitter_probability(single->emitters()[0]), 1);
    for (int i = 0; i < 4; ++i) black.add_emitter(point(0));
    const auto dark = build_with_sensor(black);
    EXPECT_EQ(dark->choose_emitter(0.6), 2U);
    EXPECT_EQ(dark->emitter_probability(dark->emitters()[3]), 0.25);
}

TEST(SceneBuilder, SceneWithoutAnythingIsEmpty) {
    SceneBuilder builder;
    const auto scene = build_with_sensor(builder);
    SurfacePoint x;
    EXPECT_FALSE(scene->intersect({{0, 0, 0}, {0, 0, 1}}, x));
    EXPECT_FALSE(scene->intersect({{0, 0, 0}, {0, 0, 1}}).has_value());
    EXPECT_TRUE(scene->unoccluded(segment({0, 0, 0}, {0, 0, 1})));
    EXPECT_TRUE(scene->emitters().empty());
    EXPECT_GT(scene->radius(), 0);
    EXPECT_EQ(scene->environment(), nullptr);
}

TEST(SceneBuilder, BoundsHoldEveryShape) {
    SceneBuilder builder;
    builder.add_sphere({10, 0, 0}, 2, {});
    builder.add_rectangle(placed(similarity(0.3, 3, {-5, 1, 1})));
    const auto scene = build_with_sensor(builder);
    Rng rng(2, 1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p = Vec3(10, 0, 0) + 2 * uniform_direction(rng);
        ASSERT_LE((p - scene->center()).norm(), scene->radius());
    }
    EXPECT_LT(scene->radius(), 15);
}

TEST(SceneBuilder, RequirementsAndStatisticsAreTheUnionOfTheParts) {
    SceneBuilder builder;
    ShapeOptions lamp = placed(similarity(0, 1, {0, 0, 4}));
    lamp.radiance = ColorInput(Spectrum(1, 2, 3));
    builder.add_rectangle(lamp);
    ShapeOptions ghost;
    ghost.bsdf = make_null();
    builder.add_sphere({0, 0, 0}, 1, ghost);
    builder.add_cube({});
    builder.add_emitter(point(1));
    builder.set_texture_statistics(2, 100);
    builder.set_max_path_length(7);
    builder.set_content_hash(42);
    const auto scene = build_with_sensor(builder);
    EXPECT_TRUE(scene->requirements().bsdfs.smooth);
    EXPECT_TRUE(scene->requirements().bsdfs.delta);
    EXPECT_TRUE(scene->requirements().delta_emitters);
    EXPECT_FALSE(scene->requirements().environment);
    EXPECT_FALSE(scene->requirements().infinite_emitters);
    EXPECT_FALSE(scene->requirements().aperture);
    const SceneStatistics& s = scene->statistics();
    EXPECT_EQ(s.triangles, 14U);
    EXPECT_EQ(s.unique_triangles, 14U);
    EXPECT_EQ(s.shapes, 3U);
    EXPECT_EQ(s.emitters, 2U);
    EXPECT_EQ(s.bsdfs, 2U);
    EXPECT_EQ(s.textures, 2U);
    EXPECT_EQ(s.texture_bytes, 100U);
    EXPECT_GT(s.mesh_bytes, 0U);
    EXPECT_GT(s.embree_bytes, 0U);
    EXPECT_EQ(scene->max_path_length(), 7);
    EXPECT_EQ(scene->content_hash(), 42U);
}

TEST(SceneBuilder, RefusesWhatCannotBe) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Affine flat = Affine::Identity(), sheared = Affine::Identity(), undefined = Affine::Identity();
    flat.linear().col(1) = flat.linear().col(0);
    sheared.linear()(0, 1) = 0.2;
    undefined.translation().x() = nan;
    SceneBuilder b;
    EXPECT_THAT(refusal([&] { b.add_cube(placed(flat)); }), HasSubstr("singular"));
    EXPECT_THAT(refusal([&] { b.add_disk(placed(flat)); }), HasSubstr("singular"));
    EXPECT_THAT(refusal([&] { b.add_disk(placed(undefined)); }), HasSubstr("not finite"));
    EXPECT_THAT(refusal([&] { b.add_sphere({0, 0, 0}, 1, placed(sheared)); }), HasSubstr("shears"));
    EXPECT_THAT(refusal([&] { b.add_sphere({0, 0, 0}, -1, {}); }), HasSubstr("radius"));
    EXPECT_THAT(refusal([&] { b.add_sphere({0, nan, 0}, 1, {}); }), HasSubstr("finite"));
    EXPECT_THAT(refusal([&] { b.add_cylinder({0, 0, 0}, {0, 0, 1}, 1, placed(sheared)); }), HasSubstr("shears"));
    EXPECT_THAT(refusal([&] { b.add_cylinder({1, 0, 0}, {1, 0, 0}, 1, {}); }), HasSubstr("different"));
    EXPECT_THAT(refusal([&] { b.add_mesh(std::make_shared<Mesh>(), {}); }), HasSubstr("no triangles"));
    const auto mesh = octasphere(0, true);
    mesh->triangles[0][0] = 6;
    EXPECT_THAT(refusal([&] { b.add_mesh(mesh, {}); }), HasSubstr("vertex index 6 is out of range"));
    const auto infinite = octasphere(0, true);
    infinite->positions[2].x() = std::numeric_limits<float>::infinity();
    EXPECT_THAT(refusal([&] { b.add_mesh(infinite, {}); }), HasSubstr("position 2 is not finite"));
    const auto uneven = octasphere(0, true);
    uneven->normals.pop_back();
    EXPECT_THAT(refusal([&] { b.add_mesh(uneven, {}); }), HasSubstr("5 normals for 6 vertices"));
    EXPECT_THAT(refusal([&] { b.add_instance("none", Affine::Identity()); }), HasSubstr("no shape group 'none'"));
    b.begin_group("g");
    EXPECT_THAT(refusal([&] { b.begin_group("h"); }), HasSubstr("cannot hold a shape group"));
    ShapeOptions lamp;
    lamp.radiance = ColorInput(Spectrum(1, 1, 1));
    EXPECT_THAT(refusal([&] { b.add_cube(lamp); }), HasSubstr("emitter cannot be part of a shape group"));
    b.end_group();
    EXPECT_THAT(refusal([&] { b.begin_group("g"); }), HasSubstr("already"));
    EXPECT_THAT(refusal([&] { b.add_instance("g", flat); }), HasSubstr("singular"));
    b.add_emitter(make_constant_emitter(Spectrum(1, 1, 1)));
    EXPECT_THAT(refusal([&] { b.add_emitter(make_constant_emitter(Spectrum(1, 1, 1))); }), HasSubstr("only one"));
    EXPECT_THAT(refusal([&] { b.build(); }), HasSubstr("no sensor"));
}

TEST(SceneBuilder, EmitterNeedsASurface) {
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    mesh->triangles = {{0, 1, 2}};
    ShapeOptions lamp;
    lamp.radiance = ColorInput(Spectrum(1, 1, 1));
    SceneBuilder builder;
    builder.add_mesh(mesh, lamp);
    EXPECT_THAT(refusal([&] { build_with_sensor(builder); }), HasSubstr("area greater than zero"));
}

// Triangles of no or hardly any area, on and among which rays are shot: nothing is ever not finite.
TEST(SceneBuilder, DegenerateTrianglesGiveNoNan) {
    auto mesh = octasphere(1, true);
    Rng rng(3, 1);
    for (int i = 0; i < 300; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh->positions.size());
        const Vec3 a = uniform_direction(rng), d = uniform_direction(rng);
        const double thin = i % 3 == 0 ? 0 : std::pow(10.0, -2 - i % 17);
        mesh->positions.push_back(a.cast<float>());
        mesh->positions.push_back(Vec3(a + d).cast<float>());
        mesh->positions.push_back(Vec3(a + 0.5 * d + thin * uniform_direction(rng)).cast<float>());
        mesh->triangles.push_back({first, first + 1, first + 2});
        mesh->normals.resize(mesh->positions.size(), i % 2 ? Vec3f(0, 0, 0) : Vec3f(0, 1, 0));
    }
    mesh->triangles.push_back({0, 0, 1});
    for (const bool tangents : {false, true}) {
        ShapeOptions options;
        if (tangents) options.bsdf = make_rough_conductor(MicrofacetType::ggx, 0.1, 0.2, {}, Spectrum(1, 1, 1));
        SceneBuilder builder;
        builder.add_mesh(mesh, options);
        const auto scene = build_with_sensor(builder);
        for (int i = 0; i < 100000; ++i) {
            const Vec3 o = 2 * uniform_direction(rng);
            const auto& triangle = mesh->triangles[rng.below(static_cast<std::uint32_t>(mesh->triangles.size()))];
            const Vec3 target = mesh->positions[triangle[0]].cast<double>() * rng.uniform() +
                                mesh->positions[triangle[1]].cast<double>() * rng.uniform();
            SurfacePoint x;
            if (!scene->intersect({o, (target - o).normalized()}, x)) continue;
            ASSERT_TRUE(x.p.allFinite() && x.ng.allFinite() && std::isfinite(x.offset));
            ASSERT_TRUE(x.frame.s.allFinite() && x.frame.t.allFinite() && x.frame.n.allFinite());
            ASSERT_NEAR(x.ng.norm(), 1, 1e-12);
            ASSERT_NEAR(x.frame.n.norm(), 1, 1e-12);
            ASSERT_NEAR(x.frame.s.dot(x.frame.n), 0, 1e-9);
        }
    }
}

// Far from the origin and near it: where only emitters are wanted they are found as ever, and what emits nothing is
// known to.
TEST(SceneQueries, OfEmittersAlone) {
    for (const double distance : {0.0, 1e6}) {
        SceneBuilder builder;
        const Vec3 center(distance, 0, 0);
        ShapeOptions lamp = placed(similarity(0.4, 1, center + Vec3(0, 0, 4)));
        lamp.radiance = ColorInput(Spectrum(1, 2, 3));
        builder.add_rectangle(lamp);
        builder.add_sphere(center - Vec3(0, 0, 4), 1, {});
        const auto scene = build_with_sensor(builder);
        int found = 0;
        Rng rng(3, 1);
        for (int i = 0; i < 2000; ++i) {
            const Ray ray{center, uniform_direction(rng)};
            SurfacePoint x, y;
            const bool hit = scene->intersect(ray, x);
            ASSERT_EQ(scene->intersect(ray, y, Wanted::emitter), hit);
            if (!hit) continue;
            ASSERT_EQ(x.emitter, y.emitter);
            if (!x.emitter) continue;
            ++found;
            ASSERT_EQ(x.p, y.p);
            ASSERT_EQ(x.ng, y.ng);
            ASSERT_EQ(x.offset, y.offset);
        }
        EXPECT_GT(found, 20);
    }
}

TEST(SceneBuilder, RobustQueriesLeakNothing) {
    SceneBuilder builder;
    builder.set_robust(true);
    builder.add_cube(placed(similarity(0.7, 1, {0.2, 0.1, -0.3})));
    const auto scene = build_with_sensor(builder);
    Rng rng(4, 1);
    for (int i = 0; i < 200000; ++i) {
        SurfacePoint x;
        ASSERT_TRUE(scene->intersect({{0.2, 0.1, -0.3}, uniform_direction(rng)}, x));
    }
}

// uv and tangents: the derivatives are those of the parametrisation, measured by neighbouring hits.
TEST(SurfaceParameters, TangentsAreTheDerivativesOfPosition) {
    const Affine place = similarity(0.9, 1.5, {1, 2, 3});
    // Without a texture, uv would not be needed and not be filled.
    const std::shared_ptr<const Texture> texture =
        make_checkerboard(Spectrum(0, 0, 0), Spectrum(1, 1, 1), Eigen::Matrix3d::Identity());
    const auto add_shapes = {+[](SceneBuilder& b, const ShapeOptions& o) { b.add_rectangle(o); },
                             +[](SceneBuilder& b, const ShapeOptions& o) { b.add_cube(o); },
                             +[](SceneBuilder& b, const ShapeOptions& o) { b.add_mesh(octasphere(1, false), o); },
                             +[](SceneBuilder& b, const ShapeOptions& o) {
                                 b.add_sphere({0, 0, 0}, 1, o);
                             },
                             +[](SceneBuilder& b, const ShapeOptions& o) { b.add_disk(o); },
                             +[](SceneBuilder& b, const ShapeOptions& o) {
                                 b.add_cylinder({0, 0, -1}, {0, 0, 1}, 1, o);
                             }};
    for (const auto& add : add_shapes) {
        for (const bool flip : {false, true}) {
            ShapeOptions options = placed(place);
            options.flip_normals = flip;
            options.bsdf = make_rough_conductor(MicrofacetType::ggx, 0.1, 0.2, {}, texture);
            SceneBuilder builder;
            add(builder, options);
            const auto scene = build_with_sensor(builder);
            Rng rng(5, 1);
            int compared = 0;
            for (int i = 0; i < 3000; ++i) {
                const Vec3 d = uniform_direction(rng);
                const Vec3 o = scene->center() + 0.5 * uniform_direction(rng) - 5 * d;
                const Vec3 aside = Vec3(d + 1e-6 * uniform_direction(rng)).normalized();
                SurfacePoint x, y;
                if (!scene->intersect({o, d}, x) || !scene->intersect({o, aside}, y)) continue;
                const Vec2 duv = y.uv - x.uv;
                // Across an edge, a seam or at a silhouette, or near a pole of the parameters.
                if ((x.ng - y.ng).norm() > 1e-4 || duv.norm() > 1e-3 || std::abs(x.ng.dot(d)) < 0.1) continue;
                if (x.du_s < 0.1) continue;
                const Vec3 predicted =
                    x.frame.s * (x.du_s * duv.x() + x.dv_s * duv.y()) + x.frame.t * (x.dv_t * duv.y());
                const Vec3 moved = y.p - x.p;
                ++compared;
                ASSERT_LE((predicted - moved).norm(), 1e-3 * moved.norm());  // second order, and floats of du_s
                ASSERT_NEAR(x.frame.s.cross(x.frame.t).dot(x.frame.n), 1, 1e-12);
            }
            EXPECT_GT(compared, 300);
        }
    }
}

}  // namespace
}  // namespace keyhole
