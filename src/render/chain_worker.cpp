#include "render/chain_worker.h"

namespace keyhole {
namespace {

Mixture<PssState, Rng> make_mixture(const std::vector<const MixStrategy*>& strategies, const StrategyContext& context) {
    std::vector<Mixture<PssState, Rng>::Component> components;
    for (const MixStrategy* s : strategies) components.push_back({s->info->make(context, s->parameters), s->weight});
    return Mixture<PssState, Rng>(std::move(components));
}

}  // namespace

std::vector<RunningChain> start_chains(std::vector<ChainGroup>& groups, std::uint64_t seed) {
    std::vector<RunningChain> chains;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        for (PssState& state : groups[g].seeds) {
            const Rng rng(seed, stream(StreamUse::chain, chains.size()));
            chains.push_back({Chain<PssState>(std::move(state)), rng, {}, g});
        }
        groups[g].seeds.clear();
    }
    return chains;
}

std::vector<const MixStrategy*> applicable_strategies(const Mix& mix, const Scene& scene) {
    std::vector<const MixStrategy*> strategies;
    for (const MixStrategy& s : mix.strategies)
        if (s.weight > 0 && s.info->hindrance(scene, mix.lengths).empty()) strategies.push_back(&s);
    return strategies;
}

ChainWorker::ChainWorker(const Scene& scene, const CoordinateLayout& layout, const TechniqueDistribution& techniques,
                         const Mix& mix, std::size_t groups)
    : chart(scene, layout, mix.target),
      mixture(make_mixture(applicable_strategies(mix, scene), {chart, techniques, mix.lengths})),
      films(groups, MetropolisFilm(scene.film())),
      diagnostics(mixture.size()),
      estimator_(chart, techniques, mix.lengths.fixed) {
    for (const MixStrategy* s : applicable_strategies(mix, scene)) independent_.push_back(s->info->independent);
}

void ChainWorker::advance(RunningChain& running, std::uint64_t mutations) {
    const WorkScope work(Phase::other);
    FilmSink sink{films[running.group]};
    for (std::uint64_t i = 0; i < mutations; ++i) {
        const StepOutcome outcome = running.chain.step(mixture, running.rng, sink, diagnostics);
        if (outcome.idle || !independent_[outcome.strategy]) continue;
        const PssState& y = running.chain.proposed(outcome);
        running.b.add(outcome.failure == Failure::none ? estimator_.estimate(y) : 0);
    }
}

}  // namespace keyhole
