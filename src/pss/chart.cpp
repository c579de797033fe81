#include "pss/chart.h"

#include <cmath>

#include "base/phase.h"

namespace keyhole {

Chart::Chart(const Scene& scene, const CoordinateLayout& layout, const ChartTarget& target)
    : tracer_(scene), layout_(&layout), target_(target), window_(scene.film()) {
    path_.room.resize(layout.max_length() + 1);
    if (layout.has_lens()) return;
    start_eye(scene, {0, 0}, pinhole_);
    path_.room[0] = pinhole_;
}

PathFailure Chart::trace_eye(const double* u, SampledPath& path) {
    const Scene& scene = tracer_.scene();
    Vertex* const x = path.room.data();
    if (layout_->has_lens())
        start_eye(scene, layout_->lens(u), x[0]);
    else if (x != path_.room.data())
        x[0] = pinhole_;
    if (path.t == 1) return PathFailure::none;
    raster_ = window_.at(layout_->raster(u));
    const int last = path.t - 1;
    const bool to_emitter = path.t == path.k + 1;
    const auto wanted = [&](int i) { return to_emitter && i == last ? Wanted::emitter : Wanted::surface; };
    Extension e = first_eye_edge(tracer_, window_, raster_, x[0], x[1], wanted(1));
    int i = 1;
    for (; i < last && e == Extension::surface; ++i) {
        const auto block = layout_->eye_block(u, i);
        e = extend(tracer_, Mode::eye, x[i - 1], x[i], x[i + 1], block.lobe, block.direction, wanted(i + 1));
    }
    if (i == last) {
        if (e == Extension::surface) return PathFailure::none;
        if (e == Extension::dark) return PathFailure::zero_bsdf;
        // Only x_k itself may lie at infinity.
        if (e == Extension::escaped && to_emitter && scene.environment()) return PathFailure::none;
    }
    return PathFailure::eye_subpath_short;
}

PathFailure Chart::trace_light(const double* u, SampledPath& path) {
    const int s = path.k + 1 - path.t;
    if (s == 0) return PathFailure::none;
    Vertex* const y = path.room.data() + path.k;  // y[-j] is the light subpath's vertex j
    if (!start_light(tracer_.scene(), layout_->emitter(u), layout_->part(u), layout_->point(u), y[0]))
        return PathFailure::light_subpath_short;
    if (s == 1) return PathFailure::none;
    Extension e = first_light_edge(tracer_, layout_->ray(u), y[0], y[-1]);
    int j = 1;
    for (; j + 1 < s && e == Extension::surface; ++j) {
        const auto block = layout_->light_block(u, j);
        e = extend(tracer_, Mode::light, y[1 - j], y[-j], y[-j - 1], block.lobe, block.direction);
    }
    return j + 1 == s && e == Extension::surface ? PathFailure::none : PathFailure::light_subpath_short;
}

Evaluation Chart::evaluate(const PrimarySample& u, SampledPath& path) {
    const PhaseScope phase(Phase::shading);
    path.k = u.k;
    path.t = u.t;
    Evaluation result;
    if ((result.failure = trace_eye(u.data(), path)) != PathFailure::none) return result;
    if ((result.failure = trace_light(u.data() + layout_->eye_count(u.t), path)) != PathFailure::none) return result;
    Connection c;
    result.failure = connect(tracer_, window_, path.eye(), path.light(), c);
    if (result.failure != PathFailure::none) return result;
    path.junction = c.junction;
    path.weight = result.weight = mis_weight(path.eye(), path.light(), c.junction, target_.techniques);
    result.raster = u.t == 1 ? c.raster : raster_;
    result.contribution = c.throughput * result.weight;
    const Spectrum& counted = target_.weighting == Weighting::target ? result.contribution : c.throughput;
    if (std::isfinite(result.contribution.sum()))
        result.target = scalar(target_.function, counted);
    else
        result.failure = PathFailure::non_finite;
    return result;
}

}  // namespace keyhole
