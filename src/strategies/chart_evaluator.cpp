#include "strategies/chart_evaluator.h"

#include <cmath>
#include <limits>

#include "strategies/technique_distribution.h"

namespace keyhole {

ChartEvaluator::ChartEvaluator(const Scene& scene, const CoordinateLayout& layout, const ChartTarget& target,
                               StateNeeds needs)
    : chart_(scene, layout, target), needs_(needs), unread_(layout) {
    if (!needs.path) return;
    weights_.resize(layout.max_length() + 1);
    if (needs.forgets) again_.room.resize(layout.max_length() + 1);
}

PssState ChartEvaluator::make_state() const {
    PssState state(chart_.layout());
    if (needs_.path) state.path.room.resize(chart_.layout().max_length() + 1);
    if (needs_.measure) state.measure = PathMeasure(chart_.layout().max_length());
    return state;
}

PathFailure ChartEvaluator::evaluate(PssState& y) {
    const Evaluation e = needs_.path ? chart_.evaluate(y.u, y.path) : chart_.evaluate(y.u);
    y.set(e);
    return e.failure;
}

std::span<const double> ChartEvaluator::weights(const PssState& x) {
    const std::span<double> all(weights_.data(), static_cast<std::size_t>(x.path.k) + 1);
    mis_weights(x.path.eye(), x.path.light(), x.path.junction, chart_.target().techniques, all);
    return all;
}

bool ChartEvaluator::invert(const PssState& x, int t, PrimarySample& u, Rng& rng) {
    return keyhole::invert(chart_.tracer().scene(), chart_.window(), chart_.layout(), x.path.x(), t, u, rng).failure ==
           InverseFailure::none;
}

bool ChartEvaluator::go_over(PssState& x, int t, PssState& y, Rng& rng) {
    if (!x.inverse_exists) x.inverse_exists = invert(x, x.u.t, unread_, rng);
    if (!x.inverse_exists || !invert(x, t, y.u, rng) || evaluate(y) != PathFailure::none) return false;
    return y.inverse_exists = deviation(y.path, x.path.x()) < largest_deviation;
}

bool ChartEvaluator::find_technique(PssState& x, Rng& rng) {
    if (x.known != Known::path) return true;
    const std::span<const double> w = weights(x);
    x.u.t = draw_index(
                x.path.k + 1, 1, [&](int i) { return w[i]; }, rng) +
            1;
    x.known = Known::technique;
    x.inverse_exists = false;
    return true;
}

bool ChartEvaluator::find_coordinates(PssState& x, Rng& rng) {
    if (x.known == Known::coordinates) return true;
    find_technique(x, rng);
    if (!invert(x, x.u.t, x.u, rng)) return false;
    const Evaluation e = chart_.evaluate(x.u, again_);
    if (e.failure != PathFailure::none || !(deviation(again_, x.path.x()) < largest_deviation)) return false;
    x.known = Known::coordinates;
    x.inverse_exists = true;
    return true;
}

const PathMeasure* ChartEvaluator::measure(const PssState& x) {
    if (!x.measured) {
        x.measured = true;
        if (keyhole::measure(chart_.tracer().scene(), chart_.window(), chart_.target().function, x.path.x(),
                             x.measure) != PathFailure::none)
            x.measure.log_f = -std::numeric_limits<double>::infinity();
    }
    return std::isfinite(x.measure.log_f) ? &x.measure : nullptr;
}

PathFailure ChartEvaluator::complete(PssState& y) {
    y.target = 0;
    y.u.k = y.path.k;
    y.known = Known::path;
    y.inverse_exists = false;
    const PathFailure failure =
        keyhole::measure(chart_.tracer().scene(), chart_.window(), chart_.target().function, y.path.x(), y.measure);
    if (failure != PathFailure::none) return failure;
    y.measured = true;
    y.raster = y.measure.raster;
    y.splat = y.measure.color;
    y.target = adopt_technique(chart_.target().techniques, y.measure, y.path);
    return y.target > 0 ? PathFailure::none : PathFailure::zero_bsdf;
}

bool ChartEvaluator::may_move_in_chart(PssState& x, Rng& rng) {
    if (needs_.forgets && !x.inverse_exists) x.inverse_exists = invert(x, x.u.t, unread_, rng);
    return !needs_.forgets || x.inverse_exists;
}

}  // namespace keyhole
