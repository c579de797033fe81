#include "render/samplers.h"

#include <cmath>

#include "base/phase.h"

namespace keyhole {
namespace {

Vec2 draw2(Rng& rng) {
    const double a = rng.uniform(), b = rng.uniform();
    return {a, b};
}

}  // namespace

void Sampler::splat(RadianceFilm& film, const Vec2& raster, const Spectrum& contribution) {
    const PhaseScope phase(Phase::film);
    if (std::isfinite(contribution.sum()))
        film.splat(raster, contribution);
    else
        ++non_finite_;
}

template <class Visit>
SensorPoint Sampler::trace_eye(const Vec2& raster, Rng& rng, Visit&& visit) {
    const bool aperture = tracer_.scene().requirements().aperture;
    const SensorPoint sensor = start_eye(tracer_.scene(), aperture ? draw2(rng) : Vec2(0, 0), eye_[0]);
    Extension e = first_eye_edge(tracer_, window_, sensor, raster, eye_[0], eye_[1]);
    for (int t = 2;; ++t) {
        if (e == Extension::absorbed) break;
        if (e == Extension::surface || tracer_.scene().environment()) visit(sensor, t);
        if (e == Extension::escaped || t > lengths_.max) break;
        const double u_lobe = rng.uniform();
        e = extend(tracer_, Mode::eye, eye_[t - 2], eye_[t - 1], eye_[t], u_lobe, draw2(rng));
    }
    return sensor;
}

void PathSampler::sample(const Vec2& raster, Rng& rng, RadianceFilm& film) {
    const Scene& scene = tracer_.scene();
    Spectrum sum = Spectrum::Zero();
    auto add = [&](const SensorPoint& sensor, std::span<const Vertex> eye, std::span<const Vertex> light) {
        Connection c;
        if (connect(tracer_, window_, sensor, eye, light, c) == PathFailure::none)
            sum += c.throughput * mis_weight(eye, light, c.junction, Techniques::unidirectional);
    };
    trace_eye(raster, rng, [&](const SensorPoint& sensor, int t) {
        const std::span<const Vertex> eye(eye_.data(), t);
        if (lengths_.contains(t - 1) && eye.back().x.emitter) add(sensor, eye, {});
        if (!lengths_.contains(t) || eye.back().infinite) return;
        Vertex y0;
        const double u_choice = rng.uniform(), u_part = rng.uniform();
        if (start_light(scene, u_choice, u_part, draw2(rng), y0)) add(sensor, eye, {&y0, 1});
    });
    splat(film, raster, sum);
}

int BdptSampler::trace_light(Rng& rng) {
    const double u_choice = rng.uniform(), u_part = rng.uniform();
    if (!start_light(tracer_.scene(), u_choice, u_part, draw2(rng), light_[0])) return 0;
    if (lengths_.max < 2) return 1;
    Extension e = first_light_edge(tracer_, draw2(rng), light_[0], light_[1]);
    int s = 1;
    while (e == Extension::surface && ++s < lengths_.max) {
        const double u_lobe = rng.uniform();
        e = extend(tracer_, Mode::light, light_[s - 2], light_[s - 1], light_[s], u_lobe, draw2(rng));
    }
    return s;
}

void BdptSampler::sample(const Vec2& raster, Rng& rng, RadianceFilm& film) {
    const int s_max = trace_light(rng);
    Spectrum sum = Spectrum::Zero();
    auto add = [&](const SensorPoint& sensor, int t, int s) {
        if (!lengths_.contains(s + t - 1)) return;
        const std::span<const Vertex> eye(eye_.data(), t), light(light_.data(), s);
        Connection c;
        if (connect(tracer_, window_, sensor, eye, light, c) != PathFailure::none) return;
        const Spectrum contribution = c.throughput * mis_weight(eye, light, c.junction, Techniques::all);
        if (t == 1)
            splat(film, c.raster, contribution);
        else
            sum += contribution;
    };
    const SensorPoint sensor = trace_eye(raster, rng, [&](const SensorPoint& at, int t) {
        if (eye_[t - 1].x.emitter) add(at, t, 0);
        if (eye_[t - 1].infinite) return;
        for (int s = 1; s <= s_max; ++s) add(at, t, s);
    });
    for (int s = 2; s <= s_max; ++s) add(sensor, 1, s);
    splat(film, raster, sum);
}

}  // namespace keyhole
