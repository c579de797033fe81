#include "pss/chart.h"

#include <cmath>

#include "base/phase.h"

namespace keyhole {

Chart::Chart(const Scene& scene, const CoordinateLayout& layout, TargetFunction target)
    : tracer_(scene),
      layout_(&layout),
      target_(target),
      window_(scene.film()),
      eye_(layout.max_length() + 1),
      light_(layout.max_length() + 1) {
    if (!layout.has_lens()) sensor_point_ = start_eye(scene, {0, 0}, eye_[0]);
}

PathFailure Chart::trace_eye(const double* u) {
    const Scene& scene = tracer_.scene();
    if (layout_->has_lens()) sensor_point_ = start_eye(scene, layout_->lens(u), eye_[0]);
    if (t_ == 1) return PathFailure::none;
    raster_ = window_.at(layout_->raster(u));
    const auto wanted = [&](int i) { return s_ == 0 && i + 1 == t_ ? Wanted::emitter : Wanted::surface; };
    Extension e = first_eye_edge(tracer_, window_, sensor_point_, raster_, eye_[0], eye_[1], wanted(1));
    int last = 1;
    for (; last + 1 < t_ && e == Extension::surface; ++last) {
        const auto block = layout_->eye_block(u, last);
        e = extend(tracer_, Mode::eye, eye_[last - 1], eye_[last], eye_[last + 1], block.lobe, block.direction,
                   wanted(last + 1));
    }
    if (last + 1 == t_) {
        if (e == Extension::surface) return PathFailure::none;
        if (e == Extension::dark) return PathFailure::zero_bsdf;
        // Only x_k itself may lie at infinity.
        if (e == Extension::escaped && s_ == 0 && scene.environment()) return PathFailure::none;
    }
    return PathFailure::eye_subpath_short;
}

PathFailure Chart::trace_light(const double* u) {
    if (s_ == 0) return PathFailure::none;
    if (!start_light(tracer_.scene(), layout_->emitter(u), layout_->part(u), layout_->point(u), light_[0]))
        return PathFailure::light_subpath_short;
    if (s_ == 1) return PathFailure::none;
    Extension e = first_light_edge(tracer_, layout_->ray(u), light_[0], light_[1]);
    int last = 1;
    for (; last + 1 < s_ && e == Extension::surface; ++last) {
        const auto block = layout_->light_block(u, last);
        e = extend(tracer_, Mode::light, light_[last - 1], light_[last], light_[last + 1], block.lobe, block.direction);
    }
    return last + 1 == s_ && e == Extension::surface ? PathFailure::none : PathFailure::light_subpath_short;
}

Evaluation Chart::evaluate(const PrimarySample& u) {
    const PhaseScope phase(Phase::shading);
    t_ = u.t;
    s_ = u.s();
    Evaluation result;
    if ((result.failure = trace_eye(u.data())) != PathFailure::none) return result;
    if ((result.failure = trace_light(u.data() + layout_->eye_count(t_))) != PathFailure::none) return result;
    result.failure = connect(tracer_, window_, sensor_point_, eye(), light(), connection_);
    if (result.failure != PathFailure::none) return result;
    result.raster = t_ == 1 ? connection_.raster : raster_;
    result.weight = mis_weight(eye(), light(), connection_.junction, Techniques::all);
    result.contribution = connection_.throughput * result.weight;
    if (std::isfinite(result.contribution.sum()))
        result.target = scalar(target_, result.contribution);
    else
        result.failure = PathFailure::non_finite;
    return result;
}

}  // namespace keyhole
