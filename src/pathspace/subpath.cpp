#include "pathspace/subpath.h"

#include <cmath>

#include "pathspace/neighbours.h"

namespace keyhole {
namespace {

// Fills what `next` needs after a ray from a finite vertex at `from` along unit `d` hit it. `pdf` is the solid-angle
// density of d; `cos_from` the geometric cosine there (1 where the vertex has no surface).
inline void arrive(const Vec3& from, const Vec3& d, double pdf, double cos_from, Vertex& next) {
    const double inv_r2 = 1 / (next.x.p - from).squaredNorm();
    next.w_prev = -next.x.frame.to_local(d);
    next.cos_prev = -next.x.ng.dot(d);
    next.to_prev = std::abs(cos_from) * inv_r2;
    next.pdf_fwd = pdf * std::abs(next.cos_prev) * inv_r2;
    next.infinite = false;
    next.delta = false;
}

// The same where the previous vertex is at infinity: `pdf` is per area perpendicular to d.
void arrive_from_infinity(const Vec3& d, double pdf, Vertex& next) {
    next.w_prev = -next.x.frame.to_local(d);
    next.cos_prev = -next.x.ng.dot(d);
    next.to_prev = 1;
    next.pdf_fwd = pdf * std::abs(next.cos_prev);
    next.infinite = false;
    next.delta = false;
}

bool is_dark(const Vertex& hit, Wanted wanted) { return wanted == Wanted::emitter && !hit.x.emitter; }

// `next` becomes the vertex at infinity in direction d.
void escape(const Scene& scene, const Vec3& d, double pdf, Vertex& next) {
    next.x.p = d;
    next.x.ng = Vec3::Zero();
    next.x.uv = {0, 0};
    next.x.bsdf = nullptr;
    next.x.emitter = scene.environment();
    next.pdf_fwd = pdf;
    next.infinite = true;
    next.delta = false;
}

}  // namespace

RasterWindow::RasterWindow(const FilmSettings& film) {
    const double border = std::max(0.0, film.filter.radius - 0.5);
    origin = {film.crop_x - border, film.crop_y - border};
    size = {film.crop_width + 2 * border, film.crop_height + 2 * border};
}

void start_eye(const Scene& scene, const Vec2& u, Vertex& x0) {
    const SensorPoint sensor = scene.sensor().sample_point(u);
    x0.x.p = sensor.p;
    x0.x.ng = Vec3::Zero();
    x0.x.bsdf = nullptr;
    x0.x.emitter = nullptr;
    x0.pdf_fwd = sensor.pdf;
    x0.infinite = scene.sensor().traits().infinite;
    x0.delta = false;
}

Extension first_eye_edge(Tracer& tracer, const RasterWindow& window, const Vec2& raster, Vertex& x0, Vertex& x1,
                         Wanted wanted) {
    const SensorRay ray = tracer.scene().sensor().ray(sensor_point(x0), raster);
    const double pdf = ray.raster_per_measure / window.area();
    x1.throughput = Spectrum::Constant(window.area());
    if (!tracer.intersect({ray.o, ray.d, 0, ray.tfar}, x1.x, wanted)) {
        escape(tracer.scene(), ray.d, pdf, x1);
        return Extension::escaped;
    }
    if (is_dark(x1, wanted)) return Extension::dark;
    if (x0.infinite)
        arrive_from_infinity(ray.d, pdf, x1);
    else
        arrive(x0.x.p, ray.d, pdf, 1, x1);
    return Extension::surface;
}

bool start_light(const Scene& scene, double u_choice, double u_part, const Vec2& u, Vertex& y0) {
    if (scene.emitters().empty()) return false;
    const Emitter& emitter = *scene.emitters()[scene.choose_emitter(u_choice)];
    const EmitterPoint e = emitter.sample_point(u_part, u);
    if (!(e.pdf > 0)) return false;
    y0.x.p = e.p;
    y0.x.ng = e.ng;
    y0.x.uv = e.uv;
    y0.x.offset = e.offset;
    y0.x.offset_per_length = e.offset_per_length;
    y0.x.primitive = e.primitive;
    y0.x.bsdf = nullptr;
    y0.x.emitter = &emitter;
    y0.pdf_fwd = e.pdf * scene.emitter_probability(&emitter);
    y0.throughput = Spectrum::Constant(1 / y0.pdf_fwd);
    y0.infinite = emitter.traits().infinite;
    y0.delta = false;
    return true;
}

Extension first_light_edge(Tracer& tracer, const Vec2& u, Vertex& y0, Vertex& y1) {
    const Emitter& emitter = *y0.x.emitter;
    const EmitterPoint e = emitter_point(y0);
    const EmissionRay ray = emitter.sample_ray(e, u);
    if (!(ray.pdf > 0)) return Extension::absorbed;
    y1.throughput = y0.throughput * emitter.emitted(e, ray.d) * (1 / ray.pdf);
    if (is_black(y1.throughput)) return Extension::absorbed;
    const bool surface = emitter.traits().surface;
    const Ray query = surface ? Scene::ray_from(e, ray.d) : Ray{ray.o, ray.d};
    if (!tracer.intersect(query, y1.x)) return Extension::escaped;
    if (y0.infinite)
        arrive_from_infinity(ray.d, ray.pdf, y1);
    else
        arrive(y0.x.p, ray.d, ray.pdf, surface ? e.ng.dot(ray.d) : 1, y1);
    return Extension::surface;
}

Extension extend(Tracer& tracer, Mode mode, Vertex& prev, Vertex& v, Vertex& next, double u_lobe, const Vec2& u,
                 Wanted wanted) {
    if (!same_side(v.cos_prev, v.w_prev.z())) return Extension::absorbed;
    const auto s = v.x.bsdf->sample(v.x, v.w_prev, u_lobe, u, mode);
    if (!s) return Extension::absorbed;
    const Vec3 d = v.x.frame.to_world(s->w);
    const double cos_next = v.x.ng.dot(d);
    if (!same_side(cos_next, s->w.z())) return Extension::absorbed;

    next.throughput = v.throughput * s->weight;
    // Adjoint of shading normals [Veach 1997, 5.3.2]: f carries |ns.w_light| / |ng.w_light|, whichever end samples.
    if (mode == Mode::light) next.throughput *= std::abs(v.w_prev.z() * cos_next / (v.cos_prev * s->w.z()));
    double pdf = s->pdf, pdf_reverse = s->pdf_reverse;
    v.delta = s->delta;
    if (s->delta) {
        v.lobe = s->lobe;
        const double eta2_next = mode == Mode::eye ? s->eta * s->eta : 1;
        const double eta2_prev = mode == Mode::eye ? 1 : 1 / (s->eta * s->eta);
        v.delta_f = s->weight * (s->pdf * eta2_next);
        pdf *= eta2_next * std::abs(s->w.z());
        pdf_reverse *= eta2_prev * std::abs(v.w_prev.z());
        v.delta_pdf_light = mode == Mode::eye ? pdf : pdf_reverse;
        v.delta_pdf_eye = mode == Mode::eye ? pdf_reverse : pdf;
    }
    prev.pdf_rev = pdf_reverse * v.to_prev;

    if (!tracer.intersect(Scene::ray_from(v.x, d), next.x, wanted)) {
        escape(tracer.scene(), d, pdf, next);
        return Extension::escaped;
    }
    if (is_dark(next, wanted)) return Extension::dark;
    arrive(v.x.p, d, pdf, cos_next, next);
    return Extension::surface;
}

Extension trace_from(Tracer& tracer, const Vertex& v, const Vec3& d, Vertex& next) {
    Ray ray{v.x.p, d};
    if (v.x.bsdf)
        ray = Scene::ray_from(v.x, d);
    else if (v.x.emitter && v.x.emitter->traits().surface)
        ray = Scene::ray_from(emitter_point(v), d);
    if (!tracer.intersect(ray, next.x)) {
        escape(tracer.scene(), d, 0, next);
        return Extension::escaped;
    }
    next.throughput = Spectrum::Ones();
    arrive(v.x.p, d, 0, v.x.ng.isZero() ? 1 : v.x.ng.dot(d), next);
    return Extension::surface;
}

void orient(const Vertex& prev, Vertex& v) {
    const Vec3 d = direction(v, prev);
    v.w_prev = v.x.frame.to_local(d);
    v.cos_prev = v.x.ng.dot(d);
    v.to_prev = to_measure(v, prev, d);
    v.throughput = Spectrum::Ones();
}

}  // namespace keyhole
