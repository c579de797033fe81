#include "render/chain_worker.h"

namespace keyhole {
namespace {

constexpr std::uint64_t observed_every = 16;  // steps

Mixture<PssState, Rng> make_mixture(const std::vector<const MixStrategy*>& strategies, const StrategyContext& context) {
    std::vector<Mixture<PssState, Rng>::Component> components;
    for (const MixStrategy* s : strategies) components.push_back({s->info->make(context, s->parameters), s->weight});
    return Mixture<PssState, Rng>(std::move(components));
}

// Both get every splat.
template <class Film>
struct PairSink {
    FilmSink<Film> film;
    BlockSink blocks;
    void splat(const PssState& state, double weight) {
        film.splat(state, weight);
        blocks.splat(state, weight);
    }
};

}  // namespace

std::vector<RunningChain> start_chains(std::vector<ChainGroup>& groups, std::uint64_t seed) {
    std::vector<RunningChain> chains;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        for (ChainSeed& start : groups[g].seeds) {
            const Rng rng(seed, stream(StreamUse::chain, chains.size()));
            chains.push_back({Chain<PssState>(std::move(start.state)),
                              rng,
                              groups[g].bridge,
                              {},
                              {},
                              0,
                              0,
                              static_cast<std::uint32_t>(g),
                              start.replicate});
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
                         const Mix& mix, std::size_t groups, ReplicateFilms* replicate_films,
                         const Recording& recording)
    : evaluator(make_evaluator(scene, layout, mix)),
      mixture(make_mixture(
          applicable_strategies(mix, scene),
          {*evaluator, dynamic_cast<ChartEvaluator*>(evaluator.get()), techniques, mix.lengths, mix.rectification})),
      films(replicate_films || !recording.films ? 0 : groups, MetropolisFilm(scene.film())),
      grid(evaluator->window(), recording.block_side),
      blocks(groups, std::vector<BlockSums>(replicate_count(mix), BlockSums(grid.count()))),
      largest(groups),
      diagnostics(mixture.size()),
      jumps(mixture.size()),
      replicate_films_(replicate_films),
      most_redraws_(mix.rectification.policy == Rectification::exclude ? most_redraws : 0),
      estimator_(*evaluator, techniques, mix.lengths.fixed) {
    for (const MixStrategy* s : applicable_strategies(mix, scene)) independent_.push_back(s->info->independent);
    if (mix.exchange_every > 0) exchange_.emplace(dynamic_cast<ChartEvaluator&>(*evaluator));
}

template <class Body>
void ChainWorker::with_sink(const RunningChain& running, const Body& body) {
    BlockSink blocks_sink{grid, blocks[running.group][running.replicate]};
    if (replicate_films_) {
        PairSink<SharedMetropolisFilm> sink{{(*replicate_films_)[running.group][running.replicate]}, blocks_sink};
        body(sink);
    } else if (films.empty()) {
        body(blocks_sink);
    } else {
        PairSink<MetropolisFilm> sink{{films[running.group]}, blocks_sink};
        body(sink);
    }
}

void ChainWorker::advance(RunningChain& running, std::uint64_t mutations) {
    const WorkScope work(Phase::other);
    with_sink(running, [&](auto& sink) { advance(running, mutations, sink); });
}

template <class Sink>
void ChainWorker::advance(RunningChain& running, std::uint64_t mutations, Sink& sink) {
    for (std::uint64_t i = 0; i < mutations;) {
        const bool excludes = running.redraws < most_redraws_;
        const StepOutcome outcome = running.chain.step(mixture, running.rng, sink, diagnostics, excludes);
        if (!outcome.idle && independent_[outcome.strategy]) add_sample(running, outcome);
        if (outcome.excluded) {
            ++running.redraws;
            continue;
        }
        running.redraws = 0;
        ++i;
        if (++running.steps % observed_every == 0) observe(running, outcome);
    }
}

void ChainWorker::add_sample(RunningChain& running, const StepOutcome& outcome) {
    const bool failed = outcome.failure != Failure::none || outcome.first_failure != Failure::none;
    const double w = failed ? 0 : estimator_.estimate(running.chain.proposed(outcome));
    running.b.add_sample(w, running.bridge);
    largest[running.group].add(w);
}

void ChainWorker::exchange(RunningChain& a, RunningChain& b, Rng& rng) {
    const WorkScope work(Phase::other);
    PssState &x = a.chain.current(), &y = b.chain.current();
    if (x.u.k != y.u.k || !evaluator->find_technique(x, rng) || !evaluator->find_technique(y, rng)) return;
    if (x.u.t == y.u.t) return;
    Proposal proposal = exchange_->propose(x, y, a.chain.spare(), b.chain.spare(), rng);
    const double probability = acceptance(proposal);
    const bool accepted = probability >= 1 || (probability > 0 && rng.uniform() < probability);
    exchanges.add(proposal.failure, probability, accepted);
    if (!accepted) return;
    for (RunningChain* chain : {&a, &b}) with_sink(*chain, [&](auto& sink) { chain->chain.leave_for_spare(sink); });
}

Observables ChainWorker::observables(const PssState& state) const {
    const RasterWindow& window = evaluator->window();
    return {std::log(state.target), (state.raster.x() - window.origin.x()) / window.size.x(),
            (state.raster.y() - window.origin.y()) / window.size.y()};
}

void ChainWorker::observe(RunningChain& running, const StepOutcome& outcome) {
    const Observables now = observables(running.chain.current());
    running.states.add(now);
    evaluator->find_technique(running.chain.current(), running.rng);
    running.b.add_state(estimator_.estimate(running.chain.current()), running.bridge);
    if (outcome.idle) return;
    // The other end of the jump. A proposal of probability zero may have no luminance, and does not count.
    const Observables other = outcome.accepted         ? observables(running.chain.previous(outcome))
                              : outcome.acceptance > 0 ? observables(running.chain.proposed(outcome))
                                                       : now;
    jumps[outcome.strategy].add(now, other, outcome.acceptance, jump_units);
}

}  // namespace keyhole
