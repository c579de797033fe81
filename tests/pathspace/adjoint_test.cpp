// Adjoint consistency with shading normals: f of one path is the same number whether light is followed from the emitter
// or importance from the sensor [Veach 1997, 5.3.2].
//
// A path that was sampled from the light and seen by the sensor is sampled again with its last vertex found by the ray
// from the sensor; one that was sampled from the sensor, with its last vertex found by the ray from the light. The
// vertices are the same, so f = throughput * densities has to be.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "pathspace/path.h"
#include "scene/scene_builder.h"
#include "scene/small_scenes.h"

namespace keyhole {
namespace {

constexpr double tolerance = 1e-6;

// Slopes that vary over the surface.
class Waves final : public Texture {
  public:
    Spectrum eval(const Vec2& uv) const override {
        return Spectrum::Constant(1 + std::sin(9 * uv.x()) * std::sin(7 * uv.y()));
    }
    Vec2 gradient(const Vec2& uv) const override {
        return {9 * std::cos(9 * uv.x()) * std::sin(7 * uv.y()), 7 * std::sin(9 * uv.x()) * std::cos(7 * uv.y())};
    }
    Spectrum mean() const override { return Spectrum::Ones(); }
    double maximum() const override { return 2; }
};

BsdfPtr bumpy(BsdfPtr bsdf, double height) { return make_bump_map(std::move(bsdf), std::make_shared<Waves>(), height); }

struct Case {
    const char* name;
    BsdfPtr bsdf;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
    const Spectrum half(0.5, 0.4, 0.3), white(1, 1, 1);
    const BsdfPtr matte = make_diffuse(half), metal = make_rough_conductor(MicrofacetType::ggx, 0.2, 0.4, {}, white),
                  glass = make_rough_dielectric(MicrofacetType::beckmann, 0.3, 0.3, 1.5, white, white);
    return {{"Diffuse", matte},
            {"RoughConductor", metal},
            {"RoughDielectric", glass},
            {"RoughPlastic", make_rough_plastic(MicrofacetType::ggx, 0.2, 1.5, half, white, true)},
            {"Phong", make_phong(20, half, half)},
            {"Plastic", make_plastic(1.5, half, white, false)},
            {"Glass", make_dielectric(1.5, white, white)},
            {"Blend", make_blend(matte, metal, 0.5)},
            {"BumpyDiffuse", bumpy(matte, 0.05)},
            {"BumpyRoughConductor", bumpy(metal, 0.05)},
            {"BumpyRoughDielectric", bumpy(glass, 0.05)},
            {"BumpyPlastic", bumpy(make_plastic(1.5, half, white, false), 0.05)}};
}

// A ball of few triangles with interpolated normals, on a floor with bumps, under a lamp.
std::unique_ptr<Scene> scene_of(const BsdfPtr& bsdf) {
    SceneBuilder builder;
    ShapeOptions ball = placed(similarity(0.4, 1, {0, 0, 0}));
    ball.bsdf = bsdf;
    builder.add_mesh(octasphere(1, true), ball);
    ShapeOptions floor = placed(Affine(Eigen::Translation3d(0, 0, -1.1) * Eigen::UniformScaling<double>(4)));
    floor.bsdf = bumpy(make_diffuse(Spectrum(0.8, 0.8, 0.8)), 0.3);
    builder.add_rectangle(floor);
    ShapeOptions lamp = placed(Affine(Eigen::Translation3d(0.5, 0, 2.5) * Eigen::AngleAxisd(pi, Vec3::UnitX())));
    lamp.radiance = ColorInput(Spectrum(3, 2, 1));
    builder.add_rectangle(lamp);
    PerspectiveParams camera;
    camera.to_world = Affine(Eigen::Translation3d(-5, 0.3, 0.5) * Eigen::AngleAxisd(pi / 2, Vec3::UnitY()));
    camera.width = camera.height = 16;
    FilmSettings film;
    film.width = film.height = film.crop_width = film.crop_height = 16;
    builder.set_sensor(make_perspective_sensor(camera), film);
    return builder.build();
}

class Adjoint : public testing::TestWithParam<Case> {
  protected:
    static constexpr int max_length = 4;
    const std::unique_ptr<Scene> scene = scene_of(GetParam().bsdf);
    const RasterWindow window{scene->film()};
    Tracer tracer{*scene};
    Rng rng{11, 1};
    std::vector<Vertex> eye = std::vector<Vertex>(max_length + 1), light = eye;
    int compared = 0, corrected = 0;

    Vec2 uniform2() { return keyhole::uniform2(rng); }

    void extend_to(Mode mode, std::vector<Vertex>& x, int n, Extension e) {
        for (int i = 1; i + 1 < n && e == Extension::surface; ++i)
            e = extend(tracer, mode, x[i - 1], x[i], x[i + 1], rng.uniform(), uniform2());
        complete_ = e == Extension::surface;
    }
    bool complete_ = false;

    bool trace_light(int n) {
        if (!start_light(*scene, rng.uniform(), rng.uniform(), uniform2(), light[0])) return false;
        complete_ = true;
        if (n > 1) extend_to(Mode::light, light, n, first_light_edge(tracer, uniform2(), light[0], light[1]));
        return complete_;
    }
    bool trace_eye(int n, const Vec2& raster) {
        start_eye(*scene, {0, 0}, eye[0]);
        extend_to(Mode::eye, eye, n, first_eye_edge(tracer, window, raster, eye[0], eye[1]));
        return complete_;
    }
    // The vertex where the emitter's ray in the direction of `y` arrives: what first_light_edge would have sampled.
    bool light_edge_towards(const Vertex& y) {
        const EmitterPoint e = emitter_point(light[0]);
        const Vec3 d = (y.x.p - e.p).normalized();
        Vertex& v = light[1];
        if (!tracer.intersect(Scene::ray_from(e, d), v.x)) return false;
        const double pdf = light[0].x.emitter->pdf_ray(e, d), inv_r2 = 1 / (v.x.p - e.p).squaredNorm();
        v.w_prev = -v.x.frame.to_local(d);
        v.cos_prev = -v.x.ng.dot(d);
        v.to_prev = std::abs(e.ng.dot(d)) * inv_r2;
        v.pdf_fwd = pdf * std::abs(v.cos_prev) * inv_r2;
        v.throughput = light[0].throughput * light[0].x.emitter->emitted(e, d) / pdf;
        v.delta = v.infinite = false;
        return true;
    }

    // f of the connected path, or zero.
    Spectrum f_of(int t, int s) {
        const std::span<const Vertex> x(eye.data(), t);
        const std::vector<Vertex> y(light.rend() - s, light.rend());
        Connection c;
        if (connect(tracer, window, x, y, c) != PathFailure::none) return Spectrum::Zero();
        raster_ = c.raster;
        double p = 1;
        for (const Vertex& v : x) p *= v.pdf_fwd;
        for (const Vertex& v : y) p *= v.pdf_fwd;
        const Spectrum f = c.throughput * p;
        const Path path = join(x, y);
        note_corrections(path);
        const Spectrum defined = contribution(*scene, path);
        EXPECT_LE((f - defined).abs().maxCoeff(), tolerance * defined.maxCoeff()) << "t = " << t << ", s = " << s;
        return f;
    }
    Vec2 raster_{0, 0};

    void expect_same(const Spectrum& from_eye, const Spectrum& from_light, int k) {
        EXPECT_LE((from_eye - from_light).abs().maxCoeff(), tolerance * from_light.maxCoeff())
            << "k = " << k << ": " << from_eye.transpose() << " from the eye, " << from_light.transpose();
        ++compared;
    }
    // Counts the vertices where leaving the correction out would show.
    void note_corrections(const Path& path) {
        for (int i = 1; i < path.length(); ++i) {
            const SurfacePoint& x = path.x[i].x;
            const auto ratio = [&](const Vertex& to) {
                const Vec3 d = to.x.p - x.p;
                return x.frame.to_local(d).z() / x.ng.dot(d);
            };
            corrected += std::abs(std::abs(ratio(path.x[i - 1]) / ratio(path.x[i + 1])) - 1) > 1e-2;
        }
    }
};

TEST_P(Adjoint, PathsOfTheLightAreThoseOfTheEye) {
    for (int i = 0; i < 60000; ++i) {
        const int k = 2 + static_cast<int>(rng.below(max_length - 1));
        start_eye(*scene, {0, 0}, eye[0]);
        if (!trace_light(k)) continue;
        const Vertex last = light[k - 1];
        const Spectrum from_light = f_of(1, k);
        if (light[k - 2].delta) continue;  // connected, it would scatter by another lobe
        if (is_black(from_light) || !trace_eye(2, raster_)) continue;
        ASSERT_LT((eye[1].x.p - last.x.p).norm(), 1e-9) << "the sensor's ray hit something else";
        expect_same(f_of(2, k - 1), from_light, k);
    }
    EXPECT_GT(compared, 100);
    EXPECT_GT(corrected, 100);
}

TEST_P(Adjoint, PathsOfTheEyeAreThoseOfTheLight) {
    for (int i = 0; i < 60000; ++i) {
        const int k = 2 + static_cast<int>(rng.below(max_length - 1));
        if (!trace_light(1) || !trace_eye(k, window.at(uniform2()))) continue;
        const Vertex& last = eye[k - 1];
        const Spectrum from_eye = f_of(k, 1);
        if (eye[k - 2].delta) continue;  // connected, it would scatter by another lobe
        if (is_black(from_eye) || !light_edge_towards(last)) continue;
        ASSERT_LT((light[1].x.p - last.x.p).norm(), 1e-9) << "the light's ray hit something else";
        const Spectrum from_light = f_of(k - 1, 2);
        expect_same(from_eye, from_light, k);
    }
    EXPECT_GT(compared, 100);
    EXPECT_GT(corrected, 100);
}

INSTANTIATE_TEST_SUITE_P(ShadingNormals, Adjoint, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace keyhole
