#include "inverse/inverse.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pathspace/path.h"

namespace keyhole {
namespace {

InverseNumbers fresh(Rng& rng) {
    InverseNumbers v;
    v.branch = rng.uniform();
    v.place = rng.uniform();
    v.direction.x() = rng.uniform();
    v.direction.y() = rng.uniform();
    return v;
}

// Unit direction from a surface vertex to any other.
Vec3 direction(const Vertex& from, const Vertex& to) {
    return to.infinite ? to.x.p : Vec3((to.x.p - from.x.p).normalized());
}

// Writes the numbers by which `v` draws the direction to `next`.
bool invert_vertex(const CoordinateLayout& layout, const Vertex& prev, const Vertex& v, const Vertex& next, Mode mode,
                   double* block, Rng& rng) {
    const Vec3 known = v.x.frame.to_local(direction(v, prev)), w = v.x.frame.to_local(direction(v, next));
    const auto n = v.x.bsdf->invert(v.x, known, w, {v.delta, v.lobe}, fresh(rng), mode);
    if (!n) return false;
    layout.set_block(block, {n->lobe, n->direction});
    return true;
}

InverseFailure invert_eye(const Scene& scene, const RasterWindow& window, const CoordinateLayout& layout,
                          std::span<const Vertex> x, int t, double* u, Rng& rng) {
    const SensorPoint e{x[0].x.p, x[0].pdf_fwd};
    const InverseNumbers v = fresh(rng);
    layout.set_lens(u, scene.sensor().invert_point(e, v.direction));
    if (t == 1) return InverseFailure::none;
    const auto view = scene.sensor().view(e, x[1].x.p);
    if (!view || !window.contains(view->raster)) return InverseFailure::sensor;
    layout.set_raster(u, window.to_unit(view->raster));
    for (int i = 1; i + 1 < t; ++i)
        if (!invert_vertex(layout, x[i - 1], x[i], x[i + 1], Mode::eye, layout.eye_block_at(u, i), rng))
            return InverseFailure::bsdf;
    return InverseFailure::none;
}

InverseFailure invert_light(const Scene& scene, const CoordinateLayout& layout, std::span<const Vertex> x, int s,
                            double* u, Rng& rng) {
    if (s == 0) return InverseFailure::none;
    const auto y = [&x](int j) -> const Vertex& { return x[x.size() - 1 - static_cast<std::size_t>(j)]; };
    const Emitter& emitter = *y(0).x.emitter;
    const EmitterPoint e = emitter_point(y(0));
    const InverseNumbers v = fresh(rng);
    const auto n = emitter.invert_point(e, v);
    if (!n) return InverseFailure::emitter;
    layout.set_emitter(u, scene.invert_choice(emitter, v.branch));
    layout.set_point(u, n->part, n->point);
    if (s == 1) return InverseFailure::none;
    const auto ray = emitter.invert_ray(e, y(1).x.p);
    if (!ray) return InverseFailure::emitter;
    layout.set_ray(u, *ray);
    for (int j = 1; j + 1 < s; ++j)
        if (!invert_vertex(layout, y(j - 1), y(j), y(j + 1), Mode::light, layout.light_block_at(u, j), rng))
            return InverseFailure::bsdf;
    return InverseFailure::none;
}

}  // namespace

InverseFailure invert(const Scene& scene, const RasterWindow& window, const CoordinateLayout& layout,
                      std::span<const Vertex> x, int t, PrimarySample& u, Rng& rng) {
    u.k = static_cast<int>(x.size()) - 1;
    u.t = t;
    if (!technique_exists(x, t)) return InverseFailure::impossible;
    if (const auto failure = invert_eye(scene, window, layout, x, t, u.data(), rng);
        failure != InverseFailure::none)
        return failure;
    return invert_light(scene, layout, x, u.s(), u.data() + layout.eye_count(t), rng);
}

double deviation(const Chart& chart, std::span<const Vertex> x) {
    const std::span<const Vertex> eye = chart.eye(), light = chart.light();
    double largest = 0;
    const auto compare = [&](const Vertex& there, const Vertex& here, const Vertex* prev, bool at_emitter) {
        // A point on an emitter has its BSDF only where it was hit.
        const bool same = at_emitter ? there.x.emitter == here.x.emitter
                                     : there.x.bsdf == here.x.bsdf && there.infinite == here.infinite;
        if (!same || there.delta != here.delta) return std::numeric_limits<double>::infinity();
        const double distance = (there.x.p - here.x.p).norm();
        const double edge = !prev || prev->infinite || there.infinite ? 1 : (there.x.p - prev->x.p).norm();
        return distance * std::max(std::sqrt(there.pdf_fwd), prev ? 1 / edge : 0);
    };
    for (std::size_t i = 0; i < eye.size(); ++i)
        largest = std::max(largest, compare(eye[i], x[i], i > 0 ? &eye[i - 1] : nullptr, i + 1 == x.size()));
    for (std::size_t j = 0; j < light.size(); ++j)
        largest = std::max(largest, compare(light[j], x[x.size() - 1 - j], j > 0 ? &light[j - 1] : nullptr, j == 0));
    return largest;
}

}  // namespace keyhole
