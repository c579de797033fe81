// What one thread runs chains with.
#pragma once

#include "chain/running_mean.h"
#include "chain/metropolis.h"
#include "render/film.h"
#include "render/render.h"
#include "strategies/mmlt.h"

namespace keyhole {

// One chain and its random numbers: all there is to save of it.
struct RunningChain {
    Chain<PssState> chain;
    Rng rng;
    RunningMean b;  // estimated by its large steps
};

struct FilmSink {
    MetropolisFilm& film;
    void splat(const PssState& state, double weight) { film.splat(state.raster, state.splat * weight); }
};

class ChainWorker {
  public:
    ChainWorker(const Scene& scene, const CoordinateLayout& layout, const TechniqueDistribution& techniques,
                const RenderSettings& settings);

    void advance(RunningChain& running, std::uint64_t mutations);

    Chart chart;
    Mixture<PssState, Rng> mixture;
    MetropolisFilm film;
    Diagnostics diagnostics;

  private:
    const TechniqueDistribution& techniques_;
};

}  // namespace keyhole
