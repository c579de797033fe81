// MMLT's mixture and a first state, for tests of chains on the project's own scenes.
#pragma once

#include "chain/metropolis.h"
#include "own_scenes.h"
#include "strategies/chart_evaluator.h"
#include "strategies/mmlt.h"

namespace keyhole {

struct MmltChain {
    MmltChain(const Scene& scene, int max_length)
        : layout(scene, max_length), evaluator(scene, layout), techniques(1, max_length), mixture(components()) {}

    // By large steps until one carries light; target 0 if none does.
    PssState first_state(Rng& rng) {
        PssState state(layout);
        const LargeStep large(evaluator, techniques);
        for (int i = 0; i < 1000000 && !(state.target > 0); ++i) large.draw(state, rng);
        return state;
    }

    CoordinateLayout layout;
    ChartEvaluator evaluator;
    TechniqueDistribution techniques;
    Mixture<PssState, Rng> mixture;

  private:
    std::vector<Mixture<PssState, Rng>::Component> components() {
        std::vector<Mixture<PssState, Rng>::Component> result;
        result.push_back({std::make_unique<LargeStep>(evaluator, techniques), 0.3});
        result.push_back({std::make_unique<SmallStep<KelemenKernel>>(evaluator, KelemenKernel()), 0.6});
        result.push_back({std::make_unique<TechniqueChange>(evaluator, techniques), 0.1});
        return result;
    }
};

}  // namespace keyhole
