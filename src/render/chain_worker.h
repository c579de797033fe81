// What one thread runs chains with.
#pragma once

#include "base/phase.h"
#include "chain/metropolis.h"
#include "chain/mixing.h"
#include "chain/normalization.h"
#include "render/block_sums.h"
#include "render/bootstrap.h"
#include "render/film.h"
#include "strategies/chart_exchange.h"
#include "strategies/mix_states.h"

namespace keyhole {

// What is followed of a state in order to know how fast chains mix: the logarithm of its target C, and its position in
// the image in shares of the window.
enum Observable { log_luminance, image_x, image_y, observable_count };
using Observables = std::array<double, observable_count>;
using ObservableMoments = StateMoments<observable_count>;
using ObservableJumps = JumpSums<observable_count>;
// Of squared jumps: finer than Kelemen's smallest steps, and enough for 10^11 proposals.
inline constexpr Observables jump_units = {0x1p-20, 0x1p-28, 0x1p-28};

// One chain and its random numbers: all there is to save of it.
struct RunningChain {
    Chain<PssState> chain;
    Rng rng;
    BridgeFunction bridge;     // of its group
    Normalization b;           // of its group, by its independent proposals and every sixteenth state
    ObservableMoments states;  // the same states
    std::uint64_t steps = 0;
    int redraws = 0;              // since the last step, of those that were excluded
    std::uint32_t group = 0;      // see ChainGroup
    std::uint32_t replicate = 0;  // see ChainSeed
};

// The chains of a bootstrap's groups, one after the other. Takes the seeds out of the groups.
std::vector<RunningChain> start_chains(std::vector<ChainGroup>& groups, std::uint64_t seed);

// The strategies of a mix that are used (weight above zero) and apply to the scene, in the mix's order.
std::vector<const MixStrategy*> applicable_strategies(const Mix& mix, const Scene& scene);

template <class Film>
struct FilmSink {
    Film& film;
    void splat(const PssState& state, double weight) {
        const PhaseScope phase(Phase::film);
        film.splat(state.raster, state.splat * weight);
        for (const Splat& splat : state.more) film.splat(splat.raster, splat.value * weight);
    }
};
template <class Film>
FilmSink(Film&) -> FilmSink<Film>;

struct BlockSink {
    const BlockGrid& grid;
    BlockSums& sums;
    void splat(const PssState& state, double weight) {
        sums.add(grid.index(state.raster), luminance(state.splat) * weight);
        for (const Splat& splat : state.more) sums.add(grid.index(splat.raster), luminance(splat.value) * weight);
    }
};

// Films that all workers add to, by group and replicate; empty where no errors of pixels are asked for.
using ReplicateFilms = std::vector<std::vector<SharedMetropolisFilm>>;

// What is kept of splats.
struct Recording {
    bool films = true;  // else there is no image
    int block_side = BlockGrid::usual_side;
};

class ChainWorker {
  public:
    // `mix` is resolved. There is a film for each of the groups, unless there are films of replicates to add to.
    ChainWorker(const Scene& scene, const CoordinateLayout& layout, const TechniqueDistribution& techniques,
                const Mix& mix, std::size_t groups, ReplicateFilms* replicate_films = nullptr,
                const Recording& recording = {});

    void advance(RunningChain& running, std::uint64_t mutations);

    // Proposes that two chains of one group and replicate exchange their paths; does nothing where they have not the
    // same length and different techniques. Only for mixes that exchange.
    void exchange(RunningChain& a, RunningChain& b, Rng& rng);

    std::unique_ptr<Evaluator> evaluator;
    Mixture<PssState, Rng> mixture;
    std::vector<MetropolisFilm> films;  // by group
    BlockGrid grid;
    std::vector<std::vector<BlockSums>> blocks;  // by group and replicate
    std::vector<Largest<heaviest>> largest;      // by group: weights of independent proposals
    Diagnostics diagnostics;
    StrategyCounts exchanges;
    std::vector<ObservableJumps> jumps;  // by strategy, of every sixteenth proposal

  private:
    // Calls body(sink) with what takes the chain's splats.
    template <class Body>
    void with_sink(const RunningChain& running, const Body& body);
    template <class Sink>
    void advance(RunningChain& running, std::uint64_t mutations, Sink& sink);
    // The proposal of an independent strategy.
    void add_sample(RunningChain& running, const StepOutcome& outcome);
    void observe(RunningChain& running, const StepOutcome& outcome);
    Observables observables(const PssState& state) const;

    ReplicateFilms* replicate_films_;
    int most_redraws_;
    std::vector<char> independent_;  // of each strategy: whether its proposals are samples for b
    LargeStep estimator_;
    std::optional<ChartExchange> exchange_;
};

}  // namespace keyhole
