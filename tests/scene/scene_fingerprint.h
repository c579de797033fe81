// What a scene does, as numbers: two scenes with the same fingerprint have the same sensor, surfaces, materials,
// lights.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace keyhole::test {

inline void append(std::vector<double>& out, const Eigen::Ref<const Eigen::VectorXd>& v) {
    out.insert(out.end(), v.begin(), v.end());
}

// Values of the BSDF, its texture lookups and its samples at one point.
inline void append_bsdf(std::vector<double>& out, const SurfacePoint& x) {
    for (const Vec3& w : {Vec3(0.3, 0.2, 0.8), Vec3(-0.5, 0.1, -0.6)}) {
        const Vec3 other = Vec3(-0.2, 0.4, 0.7).normalized();
        append(out, x.bsdf->eval(x, w.normalized(), other).f.matrix());
        for (const double u : {0.1, 0.9}) {
            const auto s = x.bsdf->sample(x, w.normalized(), u, {0.3, 0.6}, Mode::eye);
            out.push_back(s ? s->pdf : -1);
            if (s) append(out, s->weight.matrix());
            if (s) append(out, s->w);
        }
    }
}

inline std::vector<double> fingerprint(const Scene& scene) {
    std::vector<double> out;
    const FilmSettings& film = scene.film();
    for (const int i : {film.width, film.height, film.crop_x, film.crop_y, film.crop_width, film.crop_height})
        out.push_back(i);
    for (const double at : {0.1, 0.3, 0.7}) out.push_back(film.filter(at));
    out.push_back(scene.max_path_length());
    constexpr int n = 24;
    for (int i = 0; i < n * n; ++i) {
        const Vec2 raster(film.width * (i % n + 0.37) / n, film.height * (i / n + 0.61) / n);
        const SensorPoint e = scene.sensor().sample_point({0.2, 0.7});
        const SensorRay r = scene.sensor().ray(e, raster);
        append(out, r.o);
        append(out, r.d);
        const auto x = scene.intersect({r.o, r.d});
        if (!x) continue;
        append(out, x->p);
        append(out, x->frame.n);
        append(out, x->ng);
        append_bsdf(out, *x);
    }
    for (const Emitter* emitter : scene.emitters()) {
        const EmitterPoint e = emitter->sample_point(0.4, {0.3, 0.8});
        const EmissionRay r = emitter->sample_ray(e, {0.6, 0.2});
        append(out, e.p);
        append(out, r.o);
        append(out, r.d);
        append(out, emitter->emitted(e, r.d).matrix());
        append(out, emitter->power().matrix());
    }
    return out;
}

}  // namespace keyhole::test
