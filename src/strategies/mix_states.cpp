#include "strategies/mix_states.h"

#include "strategies/bundle_evaluator.h"

namespace keyhole {
namespace {

StateNeeds needs_of(const Mix& mix) {
    StateNeeds needs{.path = mix.exchange_every > 0};
    for (const MixStrategy& s : mix.strategies) {
        if (!(s.weight > 0)) continue;
        needs.path = needs.path || s.info->needs.path;
        needs.forgets = needs.forgets || s.info->needs.forgets;
        needs.measure = needs.measure || s.info->needs.measure;
    }
    return needs;
}

}  // namespace

TechniqueDistribution make_techniques(const Mix& mix) {
    if (mix.techniques.all_at_once) return TechniqueDistribution::all_at_once();
    return {mix.lengths.min, mix.lengths.max, mix.techniques.set()};
}

std::unique_ptr<Evaluator> make_evaluator(const Scene& scene, const CoordinateLayout& layout, const Mix& mix) {
    const ChartTarget target{mix.target, mix.techniques.set(), mix.techniques.weighting};
    if (mix.techniques.all_at_once)
        return std::make_unique<BundleEvaluator>(scene, layout, LengthRange{mix.lengths.min, mix.lengths.max}, target);
    return std::make_unique<ChartEvaluator>(scene, layout, target, needs_of(mix));
}

void fit_state(PssState& state, const Mix& mix) {
    const StateNeeds needs = needs_of(mix);
    if (!needs.path) state.path = {};
    if (!needs.measure) state.measure = PathMeasure();
}

std::size_t bytes_per_state(const CoordinateLayout& layout, const Mix& mix) {
    const auto longest = static_cast<std::size_t>(layout.max_length());
    if (mix.techniques.all_at_once)
        return sizeof(double) * static_cast<std::size_t>(layout.count(0, 0)) + sizeof(Splat) * longest;
    const StateNeeds needs = needs_of(mix);
    return sizeof(double) * static_cast<std::size_t>(layout.capacity()) +
           (needs.path ? sizeof(Vertex) : 0) * (longest + 1) + (needs.measure ? 3 * sizeof(double) : 0) * (longest + 1);
}

}  // namespace keyhole
