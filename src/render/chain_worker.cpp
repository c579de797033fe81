#include "render/chain_worker.h"

namespace keyhole {
namespace {

constexpr std::size_t large_step_index = 0;

Mixture<PssState, Rng> make_mixture(Chart& chart, const TechniqueDistribution& techniques,
                                    const RenderSettings& settings) {
    using Component = Mixture<PssState, Rng>::Component;
    const double large = settings.large_step_probability, change = settings.technique_change_probability;
    std::vector<Component> components;
    components.push_back({std::make_unique<LargeStep>(chart, techniques), large});
    if (settings.kernel == StepKernel::kelemen) {
        const KelemenKernel kernel(settings.kelemen_s1, settings.kelemen_s2);
        components.push_back({std::make_unique<SmallStep<KelemenKernel>>(chart, kernel), 1 - large - change});
    } else {
        const GaussianKernel kernel(settings.gaussian_sigma);
        components.push_back({std::make_unique<SmallStep<GaussianKernel>>(chart, kernel), 1 - large - change});
    }
    if (settings.max_length > 1) components.push_back({std::make_unique<TechniqueChange>(chart, techniques), change});
    return Mixture<PssState, Rng>(std::move(components));
}

}  // namespace

ChainWorker::ChainWorker(const Scene& scene, const CoordinateLayout& layout, const TechniqueDistribution& techniques,
                         const RenderSettings& settings)
    : chart(scene, layout),
      mixture(make_mixture(chart, techniques, settings)),
      film(scene.film()),
      diagnostics(mixture.size()),
      techniques_(techniques) {}

void ChainWorker::advance(RunningChain& running, std::uint64_t mutations) {
    FilmSink sink{film};
    for (std::uint64_t i = 0; i < mutations; ++i) {
        const StepOutcome outcome = running.chain.step(mixture, running.rng, sink, diagnostics);
        if (outcome.strategy != large_step_index || outcome.idle) continue;
        const PssState& y = running.chain.proposed(outcome);
        running.b.add(outcome.failure == Failure::none ? y.target / techniques_.probability(y.u.k, y.u.t) : 0);
    }
}

}  // namespace keyhole
