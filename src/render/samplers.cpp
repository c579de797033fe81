#include "render/samplers.h"

#include <cmath>

#include "base/phase.h"

namespace keyhole {
namespace {

// Fresh numbers for each vertex.
struct RandomNumbers {
    Rng& rng;
    Vec2 at;  // the raster position
    bool aperture;

    Vec2 two() {
        const double a = rng.uniform(), b = rng.uniform();
        return {a, b};
    }
    double emitter() { return rng.uniform(); }
    double part() { return rng.uniform(); }
    Vec2 point() { return two(); }
    Vec2 ray() { return two(); }
    Vec2 lens() { return aperture ? two() : Vec2(0, 0); }
    Vec2 raster() const { return at; }
    double light_lobe(int) { return rng.uniform(); }
    Vec2 light_direction(int) { return two(); }
    double eye_lobe(int) { return rng.uniform(); }
    Vec2 eye_direction(int) { return two(); }
};

}  // namespace

void Sampler::splat(RadianceFilm& film, const Vec2& raster, const Spectrum& contribution) {
    const PhaseScope phase(Phase::film);
    if (std::isfinite(contribution.sum()))
        film.splat(raster, contribution);
    else
        ++non_finite_;
}

void PathSampler::sample(const Vec2& raster, Rng& rng, RadianceFilm& film) {
    const Scene& scene = tracer_.scene();
    RandomNumbers numbers{rng, raster, scene.requirements().aperture};
    start_eye(scene, numbers.lens(), eye_[0]);
    Extension e = first_eye_edge(tracer_, window_, raster, eye_[0], eye_[1]);
    Spectrum sum = Spectrum::Zero();
    for (int t = 2; e != Extension::absorbed; ++t) {
        if (e == Extension::surface || scene.environment())
            sum += light_at({eye_.data(), static_cast<std::size_t>(t)}, rng);
        if (e == Extension::escaped || t > lengths_.max) break;
        const double u_lobe = rng.uniform();
        e = extend(tracer_, Mode::eye, eye_[t - 2], eye_[t - 1], eye_[t], u_lobe, numbers.two());
    }
    splat(film, raster, sum);
}

Spectrum PathSampler::light_at(std::span<const Vertex> eye, Rng& rng) {
    const int t = static_cast<int>(eye.size());
    Spectrum sum = Spectrum::Zero();
    if (lengths_.contains(t - 1) && eye.back().x.emitter) sum += connected(eye, {});
    if (!lengths_.contains(t) || eye.back().infinite) return sum;
    RandomNumbers numbers{rng, {0, 0}, false};
    Vertex y0;
    const double u_choice = numbers.emitter(), u_part = numbers.part();
    if (start_light(tracer_.scene(), u_choice, u_part, numbers.point(), y0)) sum += connected(eye, {&y0, 1});
    return sum;
}

Spectrum PathSampler::connected(std::span<const Vertex> eye, std::span<const Vertex> light) {
    Connection c;
    if (connect(tracer_, window_, eye, light, c) != PathFailure::none) return Spectrum::Zero();
    return c.throughput * mis_weight(eye, light, c.junction, unidirectional_techniques);
}

void BdptSampler::sample(const Vec2& raster, Rng& rng, RadianceFilm& film) {
    RandomNumbers numbers{rng, raster, connections_.tracer().scene().requirements().aperture};
    Spectrum sum = Spectrum::Zero();
    connections_.trace(numbers, [&](int t, const Vec2& at, const Spectrum& contribution) {
        if (t == 1)
            splat(film, at, contribution);
        else
            sum += contribution;
    });
    splat(film, raster, sum);
}

}  // namespace keyhole
