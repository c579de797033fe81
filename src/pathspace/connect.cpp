#include "pathspace/connect.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

// The BSDF at a subpath's last vertex towards unit `d`. `f` includes the cosine: |ns.w_light| at an eye vertex, and at
// a light vertex |ns.w_light| / |ng.w_light| |ng.w_eye| (shading normals [Veach 1997, 5.3.2]).
struct End {
    Spectrum f{0, 0, 0};
    double pdf_next = 0, pdf_prev = 0;  // solid-angle densities of d and of the direction back
    double cos_geometric = 0;           // |ng.d|
};

bool evaluate_end(const Vertex& v, Mode mode, const Vec3& d, End& end) {
    const Vec3 w = v.x.frame.to_local(d);
    const double cos_g = v.x.ng.dot(d);
    if (!same_side(cos_g, w.z()) || !same_side(v.cos_prev, v.w_prev.z())) return false;
    end.cos_geometric = std::abs(cos_g);
    if (mode == Mode::eye) {
        const BsdfValue value = v.x.bsdf->eval(v.x, v.w_prev, w);
        end.f = value.f * std::abs(w.z());
        end.pdf_next = value.pdf_light;
        end.pdf_prev = value.pdf_eye;
    } else {
        const BsdfValue value = v.x.bsdf->eval(v.x, w, v.w_prev);
        end.f = value.f * std::abs(v.w_prev.z() * cos_g / v.cos_prev);
        end.pdf_next = value.pdf_eye;
        end.pdf_prev = value.pdf_light;
    }
    return !is_black(end.f);
}

// The edge that closes a path, from one of its ends. The other may lie at infinity, in the unit direction p.
struct Edge {
    Vec3 d;  // unit direction
    double length = std::numeric_limits<double>::infinity(), inverse_length = 1, inv_r2 = 1;

    Edge(const Vec3& from, const Vec3& p, bool infinite) : d(p) {
        if (infinite) return;
        d -= from;
        length = d.norm();
        inverse_length = 1 / length;
        inv_r2 = sqr(inverse_length);
        d *= inverse_length;
    }
};

// The shadow rays of the three kinds of edges: from a surface to the sensor, to an emitter's point and to a surface. A
// sensor or a point light lies on no surface, so that no error counts there.
bool sensor_sees(Tracer& tracer, const SensorView& view, const Vertex& x0, const Vertex& y, const Edge& edge) {
    const double inverse_length = x0.infinite ? 1 / (view.o - y.x.p).norm() : edge.inverse_length;
    return tracer.visible(Scene::offset_origin(y.x, edge.d), view.o, inverse_length);
}
bool emitter_seen(Tracer& tracer, const Vertex& x, const Vertex& y, const Edge& edge) {
    const Vec3 o = Scene::offset_origin(x.x, edge.d);
    if (y.infinite) return tracer.unoccluded({o, edge.d});
    const bool surface = y.x.emitter && y.x.emitter->traits().surface;
    return tracer.visible(o, surface ? Scene::offset_target(y.x, -edge.d, edge.length) : y.x.p, edge.inverse_length);
}
bool surfaces_see(Tracer& tracer, const Vertex& x, const Vertex& y, const Edge& edge) {
    return tracer.visible(Scene::offset_origin(x.x, edge.d), Scene::offset_target(y.x, -edge.d, edge.length),
                          edge.inverse_length);
}

// s = 0: x_k lies on an emitter.
PathFailure hit_emitter(const Scene& scene, std::span<const Vertex> eye, Connection& c) {
    const Vertex& x = eye.back();
    const Emitter* emitter = x.x.emitter;
    if (!emitter) return PathFailure::zero_bsdf;
    const EmitterPoint e = emitter_point(x);
    const Vec3 w = x.infinite ? Vec3(-x.x.p) : x.x.frame.to_world(x.w_prev);
    c.throughput = x.throughput * emitter->radiance(e, w);
    if (is_black(c.throughput)) return PathFailure::zero_bsdf;
    c.junction.light_t1 = scene.emitter_probability(emitter) * emitter->pdf_point(e);
    // From the emitter to x_{k-1}: solid angle to area, or per perpendicular area times the cosine there.
    const Vertex& previous = eye[eye.size() - 2];
    double to_previous = x.to_prev;
    if (x.infinite) to_previous = eye.size() > 2 ? std::abs(previous.x.ng.dot(x.x.p)) : 0;
    c.junction.light_t2 = emitter->pdf_ray(e, w) * to_previous;
    return PathFailure::none;
}

// t = 1: y_{s-1} is seen by the sensor.
PathFailure see_from_sensor(Tracer& tracer, const RasterWindow& window, const Vertex& x0, std::span<const Vertex> light,
                            Connection& c) {
    const Vertex& y = light.front();
    const auto view = tracer.scene().sensor().view(sensor_point(x0), y.x.p);
    if (!view || !window.contains(view->raster)) return PathFailure::outside_film;
    c.raster = view->raster;
    const Edge edge(y.x.p, x0.x.p, x0.infinite);
    End end;
    if (!evaluate_end(y, Mode::light, edge.d, end)) return PathFailure::zero_bsdf;
    if (!sensor_sees(tracer, *view, x0, y, edge)) return PathFailure::occluded;
    c.throughput = y.throughput * end.f * (view->importance * edge.inv_r2 / x0.pdf_fwd);
    c.junction.eye_t = view->raster_per_measure / window.area() * end.cos_geometric * edge.inv_r2;
    c.junction.eye_t1 = end.pdf_prev * y.to_prev;
    return PathFailure::none;
}

// s = 1: next-event estimation.
PathFailure connect_emitter(Tracer& tracer, std::span<const Vertex> eye, const Vertex& y, Connection& c) {
    const Vertex& x = eye.back();
    const Emitter& emitter = *y.x.emitter;
    const EmitterPoint e = emitter_point(y);
    const Edge edge(x.x.p, y.x.p, y.infinite);
    const Vec3& d = edge.d;
    const double inv_r2 = edge.inv_r2;
    const Spectrum emitted = emitter.emitted(e, -d);
    End end;
    if (is_black(emitted) || !evaluate_end(x, Mode::eye, d, end)) return PathFailure::zero_bsdf;
    if (!emitter_seen(tracer, x, y, edge)) return PathFailure::occluded;
    c.throughput = x.throughput * end.f * y.throughput * emitted * inv_r2;
    c.junction.light_t1 = emitter.pdf_ray(e, -d) * end.cos_geometric * inv_r2;
    c.junction.light_t2 = end.pdf_prev * x.to_prev;
    c.junction.eye_t = end.pdf_next * (emitter.traits().surface ? std::abs(y.x.ng.dot(d)) * inv_r2 : 1);
    return PathFailure::none;
}

PathFailure connect_surfaces(Tracer& tracer, std::span<const Vertex> eye, std::span<const Vertex> light,
                             Connection& c) {
    const Vertex &x = eye.back(), &y = light.front();
    const Edge edge(x.x.p, y.x.p, false);
    const Vec3& d = edge.d;
    const double inv_r2 = edge.inv_r2;
    if (!std::isfinite(inv_r2)) return PathFailure::occluded;
    End at_x, at_y;
    if (!evaluate_end(x, Mode::eye, d, at_x) || !evaluate_end(y, Mode::light, -d, at_y)) return PathFailure::zero_bsdf;
    if (!surfaces_see(tracer, x, y, edge)) return PathFailure::occluded;
    c.throughput = x.throughput * at_x.f * at_y.f * y.throughput * inv_r2;
    c.junction.light_t1 = at_y.pdf_next * at_x.cos_geometric * inv_r2;
    c.junction.light_t2 = at_x.pdf_prev * x.to_prev;
    c.junction.eye_t = at_x.pdf_next * at_y.cos_geometric * inv_r2;
    c.junction.eye_t1 = at_y.pdf_prev * y.to_prev;
    return PathFailure::none;
}

// Calls visit(t', p_t' / p_t) for the techniques t' != t of the set that can make the path.
template <class Visit>
inline void for_density_ratios(std::span<const Vertex> eye, std::span<const Vertex> light, const Junction& junction,
                               TechniqueSet techniques, const Visit& visit) {
    const int t = static_cast<int>(eye.size()), s = static_cast<int>(light.size()), k = s + t - 1;
    // Towards the emitter: technique i+1 makes x_i from the eye side and connects x_i to x_{i+1}. The connected
    // vertices scatter by smooth lobes.
    double ratio = 1;
    for (int i = t; i <= k; ++i) {
        const Vertex& v = light[i - t];
        const double eye_pdf = i == t ? junction.eye_t : (i == t + 1 ? junction.eye_t1 : v.pdf_rev);
        ratio *= eye_pdf / v.pdf_fwd;
        if (i == k) {
            const EmitterTraits& emitter = v.x.emitter->traits();
            if ((emitter.surface || emitter.environment) && !emitter.delta && techniques.holds(0)) visit(k + 1, ratio);
            break;
        }
        const bool delta = i > t && v.delta;
        const bool next_delta = i + 1 < k && light[i + 1 - t].delta;
        if (!delta && !next_delta && techniques.holds(k - i)) visit(i + 1, ratio);
    }
    // Towards the sensor: technique i connects x_{i-1} to x_i.
    ratio = 1;
    bool previous_delta = false;
    for (int i = t - 1; i >= 1; --i) {
        const Vertex& v = eye[i];
        const double light_pdf = i == t - 1 ? junction.light_t1 : (i == t - 2 ? junction.light_t2 : v.pdf_rev);
        ratio *= light_pdf / v.pdf_fwd;
        if (k == 1) break;
        const bool delta = previous_delta;
        previous_delta = i > 1 && eye[i - 1].delta;
        if (!delta && !previous_delta && techniques.holds(k + 1 - i)) visit(i, ratio);
    }
}

}  // namespace

PathFailure connect(Tracer& tracer, const RasterWindow& window, std::span<const Vertex> eye,
                    std::span<const Vertex> light, Connection& c) {
    if (light.empty()) return hit_emitter(tracer.scene(), eye, c);
    if (eye.size() > 1 && !has_smooth_lobe(eye.back())) return PathFailure::zero_bsdf;
    if (light.size() > 1 && !has_smooth_lobe(light.front())) return PathFailure::zero_bsdf;
    if (eye.size() == 1) {
        if (light.size() == 1) return PathFailure::zero_bsdf;
        return see_from_sensor(tracer, window, eye.front(), light, c);
    }
    if (light.size() == 1) return connect_emitter(tracer, eye, light.front(), c);
    return connect_surfaces(tracer, eye, light, c);
}

bool visible(Tracer& tracer, const Vertex& x, const Vertex& y) {
    if (!x.x.bsdf) {
        const Edge edge(y.x.p, x.x.p, x.infinite);
        const auto view = tracer.scene().sensor().view(sensor_point(x), y.x.p);
        return view && sensor_sees(tracer, *view, x, y, edge);
    }
    const Edge edge(x.x.p, y.x.p, y.infinite);
    return y.x.bsdf ? surfaces_see(tracer, x, y, edge) : emitter_seen(tracer, x, y, edge);
}

double mis_weight(std::span<const Vertex> eye, std::span<const Vertex> light, const Junction& junction,
                  TechniqueSet techniques) {
    double sum = 1;
    for_density_ratios(eye, light, junction, techniques, [&](int, double ratio) { sum += ratio; });
    return 1 / sum;
}

void mis_weights(std::span<const Vertex> eye, std::span<const Vertex> light, const Junction& junction,
                 TechniqueSet techniques, std::span<double> weights) {
    std::fill(weights.begin(), weights.end(), 0.0);
    double sum = weights[eye.size() - 1] = 1;
    for_density_ratios(eye, light, junction, techniques, [&](int t, double ratio) {
        weights[t - 1] = ratio;
        sum += ratio;
    });
    for (double& w : weights) w /= sum;
}

}  // namespace keyhole
