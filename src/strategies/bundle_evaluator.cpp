#include "strategies/bundle_evaluator.h"

#include <cmath>

#include "base/phase.h"

namespace keyhole {
namespace {

// Reads the subpaths' numbers from a point of primary sample space.
struct Coordinates {
    const CoordinateLayout& layout;
    const RasterWindow& window;
    const double *eye, *light;

    double emitter() const { return layout.emitter(light); }
    double part() const { return layout.part(light); }
    Vec2 point() const { return layout.point(light); }
    Vec2 ray() const { return layout.ray(light); }
    Vec2 lens() const { return layout.lens(eye); }
    Vec2 raster() const { return window.at(layout.raster(eye)); }
    double light_lobe(int vertex) const { return layout.light_block(light, vertex).lobe; }
    Vec2 light_direction(int vertex) const { return layout.light_block(light, vertex).direction; }
    double eye_lobe(int vertex) const { return layout.eye_block(eye, vertex).lobe; }
    Vec2 eye_direction(int vertex) const { return layout.eye_block(eye, vertex).direction; }
};

}  // namespace

BundleEvaluator::BundleEvaluator(const Scene& scene, const CoordinateLayout& layout, LengthRange lengths,
                                 const ChartTarget& target)
    : layout_(&layout), target_(target.function), connections_(scene, lengths, target.techniques) {}

PssState BundleEvaluator::make_state() const {
    PssState state(*layout_);
    state.u.coordinates.resize(whole_lanes(layout_->count(0, 0)));
    state.more.reserve(static_cast<std::size_t>(layout_->max_length()));
    return state;
}

PathFailure BundleEvaluator::evaluate(PssState& y) {
    const PhaseScope phase(Phase::shading);
    Coordinates numbers{*layout_, window(), y.u.data(), y.u.data() + layout_->bundle_eye_count()};
    y.target = 0;
    y.splat = Spectrum::Zero();
    y.raster = numbers.raster();
    y.more.clear();
    bool finite = true;
    connections_.trace(numbers, [&](int t, const Vec2& raster, const Spectrum& contribution) {
        finite = finite && std::isfinite(contribution.sum());
        y.target += scalar(target_, contribution);
        if (t == 1)
            y.more.push_back({contribution, raster});
        else
            y.splat += contribution;
    });
    if (!finite || !std::isfinite(y.target)) {
        y.target = 0;
        return PathFailure::non_finite;
    }
    if (!(y.target > 0)) return PathFailure::zero_bsdf;
    y.splat /= y.target;
    for (Splat& splat : y.more) splat.value /= y.target;
    return PathFailure::none;
}

}  // namespace keyhole
