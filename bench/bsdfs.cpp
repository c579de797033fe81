// Sampling and evaluation of every BSDF, at directions of all angles.
#include "scene/bsdfs.h"

#include <benchmark/benchmark.h>

#include <string>

#include "base/warp.h"
#include "inputs.h"
#include "scene/texture.h"

namespace keyhole {
namespace {

const Spectrum gray(0.4, 0.5, 0.6), white(1, 1, 1);
const ConductorIor copper{{0.2, 0.92, 1.1}, {3.9, 2.45, 2.14}};
constexpr double glass = 1.5;

std::shared_ptr<const Texture> checkerboard() {
    return make_checkerboard(gray, white, Eigen::Matrix3d::Identity());
}

void sample(benchmark::State& state, const BsdfPtr& bsdf) {
    struct Input {
        Vec3 w;
        double lobe;
        Vec2 u;
    };
    Inputs<Input> inputs([](Rng& rng) {
        return Input{square_to_cosine_hemisphere(uniform2(rng)), rng.uniform(), uniform2(rng)};
    });
    SurfacePoint x{};
    x.frame = Frame::from_normal({0, 0, 1});
    for (auto _ : state) {
        const Input& in = inputs.next();
        benchmark::DoNotOptimize(bsdf->sample(x, in.w, in.lobe, in.u, Mode::eye));
    }
}

void evaluate(benchmark::State& state, const BsdfPtr& bsdf) {
    Inputs<std::pair<Vec3, Vec3>> inputs([](Rng& rng) {
        const Vec3 w = square_to_cosine_hemisphere(uniform2(rng));
        return std::pair<Vec3, Vec3>(w, square_to_cosine_hemisphere(uniform2(rng)));
    });
    SurfacePoint x{};
    x.frame = Frame::from_normal({0, 0, 1});
    for (auto _ : state) {
        const auto& [w_eye, w_light] = inputs.next();
        benchmark::DoNotOptimize(bsdf->eval(x, w_eye, w_light));
    }
}

void add(const std::string& name, const BsdfPtr& bsdf) {
    benchmark::RegisterBenchmark(("bsdf_sample/" + name).c_str(), sample, bsdf);
    if (bsdf->traits().smooth) benchmark::RegisterBenchmark(("bsdf_eval/" + name).c_str(), evaluate, bsdf);
}

const bool added = [] {
    const BsdfPtr diffuse = make_diffuse(gray);
    add("diffuse", diffuse);
    add("diffuse_textured", make_diffuse(checkerboard()));
    add("conductor", make_conductor(copper, white));
    add("dielectric", make_dielectric(glass, white, white));
    add("thindielectric", make_thin_dielectric(glass, white, white));
    add("plastic", make_plastic(glass, gray, white, true));
    for (const auto& [suffix, type] : {std::pair("ggx", MicrofacetType::ggx), {"beckmann", MicrofacetType::beckmann}}) {
        add(std::string("roughconductor_") + suffix, make_rough_conductor(type, 0.1, 0.3, copper, white));
        add(std::string("roughdielectric_") + suffix, make_rough_dielectric(type, 0.1, 0.1, glass, white, white));
        add(std::string("roughplastic_") + suffix, make_rough_plastic(type, 0.1, glass, gray, white, true));
    }
    add("phong", make_phong(30, gray, Spectrum(0.2, 0.2, 0.2)));
    add("mask", make_mask(diffuse, 0.5));
    add("twosided", make_two_sided(diffuse, diffuse));
    add("bumpmap", make_bump_map(diffuse, checkerboard(), 1));
    add("blendbsdf", make_blend(diffuse, make_conductor(copper, white), 0.5));
    add("null", make_null());
    return true;
}();

}  // namespace
}  // namespace keyhole
