#include "inverse/inverse.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pathspace/neighbours.h"
#include "pathspace/path.h"

namespace keyhole {
namespace {

// Writes the numbers by which `v` draws the direction to `next`.
bool invert_vertex(const CoordinateLayout& layout, const Vertex& prev, const Vertex& v, const Vertex& next, Mode mode,
                   double* block, Rng& rng) {
    const Vec3 known = v.x.frame.to_local(direction(v, prev)), w = v.x.frame.to_local(direction(v, next));
    const auto n = v.x.bsdf->invert(v.x, known, w, {v.delta, v.lobe}, fresh_numbers(rng), mode);
    if (!n) return false;
    layout.set_block(block, {n->lobe, n->direction});
    return true;
}

Inversion invert_eye(const Scene& scene, const RasterWindow& window, const CoordinateLayout& layout,
                     std::span<const Vertex> x, int t, double* u, Rng& rng) {
    const SensorPoint e = sensor_point(x[0]);
    const InverseNumbers v = fresh_numbers(rng);
    layout.set_lens(u, scene.sensor().invert_point(e, v.direction));
    if (t == 1) return {};
    const auto view = scene.sensor().view(e, x[1].x.p);
    if (!view || !window.contains(view->raster)) return {InverseFailure::sensor, 0};
    layout.set_raster(u, window.to_unit(view->raster));
    for (int i = 1; i + 1 < t; ++i)
        if (!invert_vertex(layout, x[i - 1], x[i], x[i + 1], Mode::eye, layout.eye_block_at(u, i), rng))
            return {InverseFailure::bsdf, i};
    return {};
}

Inversion invert_light(const Scene& scene, const CoordinateLayout& layout, std::span<const Vertex> x, int s, double* u,
                       Rng& rng) {
    const int k = static_cast<int>(x.size()) - 1;
    if (s == 0) return {};
    const Emitter& emitter = *x[k].x.emitter;
    const EmitterPoint e = emitter_point(x[k]);
    const InverseNumbers v = fresh_numbers(rng);
    const auto n = emitter.invert_point(e, v);
    if (!n) return {InverseFailure::emitter, k};
    layout.set_emitter(u, scene.invert_choice(emitter, v.branch));
    layout.set_point(u, n->part, n->point);
    if (s == 1) return {};
    const auto ray = emitter.invert_ray(e, x[k - 1].x.p);
    if (!ray) return {InverseFailure::emitter, k};
    layout.set_ray(u, *ray);
    for (int j = 1; j + 1 < s; ++j)
        if (const int i = k - j;
            !invert_vertex(layout, x[i + 1], x[i], x[i - 1], Mode::light, layout.light_block_at(u, j), rng))
            return {InverseFailure::bsdf, i};
    return {};
}

}  // namespace

Inversion invert(const Scene& scene, const RasterWindow& window, const CoordinateLayout& layout,
                 std::span<const Vertex> x, int t, PrimarySample& u, Rng& rng) {
    u.k = static_cast<int>(x.size()) - 1;
    u.t = t;
    if (!technique_exists(x, t)) return {InverseFailure::impossible, 0};
    const Inversion eye = invert_eye(scene, window, layout, x, t, u.data(), rng);
    if (eye.failure != InverseFailure::none) return eye;
    return invert_light(scene, layout, x, u.s(), u.data() + layout.eye_count(t), rng);
}

double deviation(const SampledPath& traced, std::span<const Vertex> x, int i) {
    const int t = traced.t, k = traced.k;
    const Vertex &here = x[i], &there = traced.x()[i];
    // A point on an emitter has its BSDF only where it was hit.
    const bool same =
        i == k ? there.x.emitter == here.x.emitter : there.x.bsdf == here.x.bsdf && there.infinite == here.infinite;
    // On an edge, a ray from elsewhere may hit the other triangle.
    const bool same_plane = (there.x.ng - here.x.ng).norm() < largest_deviation;
    if (!same || !same_plane || there.delta != here.delta) return std::numeric_limits<double>::infinity();
    const double distance = (there.x.p - here.x.p).norm(), in_widths = distance * std::sqrt(there.pdf_fwd);
    if (i == 0 || (i == k && i >= t)) return in_widths;  // the subpath's start
    const Vertex& prev = traced.x()[i < t ? i - 1 : i + 1];
    if (there.infinite) return std::max(in_widths, distance);
    return std::max(in_widths, prev.infinite ? 0 : distance / (there.x.p - prev.x.p).norm());
}

double deviation(const SampledPath& traced, std::span<const Vertex> x) {
    double largest = 0;
    for (int i = 0; i < static_cast<int>(x.size()); ++i) largest = std::max(largest, deviation(traced, x, i));
    return largest;
}

}  // namespace keyhole
