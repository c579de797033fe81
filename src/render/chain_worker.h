// What one thread runs chains with.
#pragma once

#include "base/phase.h"
#include "chain/metropolis.h"
#include "chain/running_mean.h"
#include "render/bootstrap.h"
#include "render/film.h"
#include "strategies/mix.h"

namespace keyhole {

// One chain and its random numbers: all there is to save of it.
struct RunningChain {
    Chain<PssState> chain;
    Rng rng;
    RunningMean b;          // of its group, estimated by its independent proposals
    std::size_t group = 0;  // see ChainGroup
};

// The chains of a bootstrap's groups, one after the other. Takes the seeds out of the groups.
std::vector<RunningChain> start_chains(std::vector<ChainGroup>& groups, std::uint64_t seed);

// The strategies of a mix that are used (weight above zero) and apply to the scene, in the mix's order.
std::vector<const MixStrategy*> applicable_strategies(const Mix& mix, const Scene& scene);

struct FilmSink {
    MetropolisFilm& film;
    void splat(const PssState& state, double weight) {
        const PhaseScope phase(Phase::film);
        film.splat(state.raster, state.splat * weight);
    }
};

class ChainWorker {
  public:
    // `mix` is resolved. One film for each of the groups.
    ChainWorker(const Scene& scene, const CoordinateLayout& layout, const TechniqueDistribution& techniques,
                const Mix& mix, std::size_t groups);

    void advance(RunningChain& running, std::uint64_t mutations);

    Chart chart;
    Mixture<PssState, Rng> mixture;
    std::vector<MetropolisFilm> films;  // by group
    Diagnostics diagnostics;

  private:
    std::vector<char> independent_;  // of each strategy: whether its proposals estimate b
    LargeStep estimator_;
};

}  // namespace keyhole
