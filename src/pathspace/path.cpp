#include "pathspace/path.h"

#include <cmath>

#include "pathspace/neighbours.h"

namespace keyhole {
namespace {

Scattering event(const Path& path, int i) {
    const Vertex& v = path.x[i];
    return scattering(v, direction(v, path.x[i - 1]), direction(v, path.x[i + 1]));
}

}  // namespace

Path join(std::span<const Vertex> eye, std::span<const Vertex> light) {
    Path path;
    path.x.assign(eye.begin(), eye.end());
    path.x.insert(path.x.end(), light.begin(), light.end());
    // The connected vertices scatter by smooth lobes, whatever their subpath may have done there afterwards.
    if (!eye.empty() && !light.empty()) path.x[eye.size() - 1].delta = path.x[eye.size()].delta = false;
    return path;
}

Spectrum contribution(const Scene& scene, const Path& path) {
    const int k = path.length();
    const Vertex &x0 = path.x[0], &xk = path.x[k];
    if (!xk.x.emitter) return Spectrum::Zero();
    const Vertex& x1 = path.x[1];
    // From the sensor: importance per solid angle (or perpendicular area), and the rest of the first geometry term.
    const auto view =
        scene.sensor().view(sensor_point(x0), x1.infinite ? Vec3(x0.x.p + scene.radius() * x1.x.p) : x1.x.p);
    if (!view) return Spectrum::Zero();
    Spectrum f = Spectrum::Constant(view->importance * to_measure(x0, x1, x1.infinite ? x1.x.p : direction(x1, x0)));
    for (int i = 1; i < k; ++i) {
        const Vertex &v = path.x[i], &next = path.x[i + 1];
        const Vec3 d = direction(v, next);
        f *= event(path, i).f * std::abs(v.x.ng.dot(d));
        // The far cosine of the last edge is part of `emitted`.
        if (i + 1 < k)
            f *= to_measure(v, next, d);
        else if (!next.infinite)
            f /= (next.x.p - v.x.p).squaredNorm();
    }
    const Vertex& before = path.x[k - 1];
    const Vec3 w = xk.infinite ? Vec3(-xk.x.p) : Vec3((before.x.p - xk.x.p).normalized());
    const EmitterPoint e = emitter_point(xk);
    return f * (k == 1 ? xk.x.emitter->radiance(e, w) : xk.x.emitter->emitted(e, w));
}

PathDensities densities(const Scene& scene, const RasterWindow& window, const Path& path) {
    const int k = path.length();
    PathDensities p{std::vector<double>(k + 1, 0.0), std::vector<double>(k + 1, 0.0)};
    const Vertex &x0 = path.x[0], &x1 = path.x[1], &xk = path.x[k];
    p.eye[0] = x0.pdf_fwd;
    if (const auto view =
            scene.sensor().view(sensor_point(x0), x1.infinite ? Vec3(x0.x.p + scene.radius() * x1.x.p) : x1.x.p))
        p.eye[1] =
            view->raster_per_measure / window.area() * to_measure(x0, x1, x1.infinite ? x1.x.p : direction(x1, x0));
    const Emitter& emitter = *xk.x.emitter;
    const EmitterPoint e = emitter_point(xk);
    p.light[k] = scene.emitter_probability(&emitter) * (emitter.traits().delta ? 1 : emitter.pdf_point(e));
    if (k > 1) {
        const Vertex& before = path.x[k - 1];
        const Vec3 w = xk.infinite ? Vec3(-xk.x.p) : direction(xk, before);
        p.light[k - 1] = emitter.pdf_ray(e, w) * to_measure(xk, before, w);
    }
    for (int i = 1; i < k; ++i) {
        const Scattering at = event(path, i);
        const Vertex &v = path.x[i], &before = path.x[i - 1], &after = path.x[i + 1];
        p.eye[i + 1] = at.pdf_light * to_measure(v, after, direction(v, after));
        if (i > 1) p.light[i - 1] = at.pdf_eye * to_measure(v, before, direction(v, before));
    }
    return p;
}

bool technique_exists(std::span<const Vertex> x, int t) {
    const int k = static_cast<int>(x.size()) - 1;
    if (t < 1 || t > k + 1) return false;
    if (k == 1) return t == 2;
    if (t == k + 1) {
        const EmitterTraits& emitter = x.back().x.emitter->traits();
        return emitter.surface || emitter.environment;
    }
    return !x[t - 1].delta && !x[t].delta;
}

}  // namespace keyhole
