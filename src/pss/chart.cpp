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
      light_(layout.max_length() + 1) {}

PathFailure Chart::trace_eye(const PrimarySample& u) {
    const double* coordinates = u.eye.data();
    sensor_point_ = start_eye(tracer_.scene(), layout_->lens(coordinates), eye_[0]);
    if (t_ == 1) return PathFailure::none;
    raster_ = window_.at(layout_->raster(coordinates));
    Extension e = first_eye_edge(tracer_, window_, sensor_point_, raster_, eye_[0], eye_[1]);
    int last = 1;
    for (; last + 1 < t_ && e == Extension::surface; ++last) {
        const auto block = layout_->eye_block(coordinates, last);
        e = extend(tracer_, Mode::eye, eye_[last - 1], eye_[last], eye_[last + 1], block.lobe, block.direction);
    }
    // Only x_k itself may lie at infinity.
    const bool at_emitter = e == Extension::escaped && s_ == 0 && tracer_.scene().environment();
    return last + 1 == t_ && (e == Extension::surface || at_emitter) ? PathFailure::none
                                                                     : PathFailure::eye_subpath_short;
}

PathFailure Chart::trace_light(const PrimarySample& u) {
    if (s_ == 0) return PathFailure::none;
    const double* coordinates = u.light.data();
    if (!start_light(tracer_.scene(), layout_->emitter(coordinates), layout_->part(coordinates),
                     layout_->point(coordinates), light_[0]))
        return PathFailure::light_subpath_short;
    if (s_ == 1) return PathFailure::none;
    Extension e = first_light_edge(tracer_, layout_->ray(coordinates), light_[0], light_[1]);
    int last = 1;
    for (; last + 1 < s_ && e == Extension::surface; ++last) {
        const auto block = layout_->light_block(coordinates, last);
        e = extend(tracer_, Mode::light, light_[last - 1], light_[last], light_[last + 1], block.lobe, block.direction);
    }
    return last + 1 == s_ && e == Extension::surface ? PathFailure::none : PathFailure::light_subpath_short;
}

Evaluation Chart::evaluate(const PrimarySample& u) {
    const PhaseScope phase(Phase::shading);
    t_ = u.t;
    s_ = u.s();
    Evaluation result;
    if ((result.failure = trace_eye(u)) != PathFailure::none) return result;
    if ((result.failure = trace_light(u)) != PathFailure::none) return result;
    const Connection c = connect(tracer_, window_, sensor_point_, eye(), light());
    if ((result.failure = c.failure) != PathFailure::none) return result;
    junction_ = c.junction;
    result.raster = t_ == 1 ? c.raster : raster_;
    result.contribution = c.throughput * mis_weight(eye(), light(), c.junction, Techniques::all);
    if (std::isfinite(result.contribution.sum()))
        result.target = scalar(target_, result.contribution);
    else
        result.failure = PathFailure::non_finite;
    return result;
}

}  // namespace keyhole
