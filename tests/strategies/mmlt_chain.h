// MMLT's mixture and a first state, for tests of chains on the project's own scenes.
#pragma once

#include "chain/metropolis.h"
#include "own_scenes.h"
#include "strategies/mmlt.h"

namespace keyhole {

struct MmltChain {
    MmltChain(const Scene& scene, int max_length)
        : layout(scene, max_length), chart(scene, layout), techniques(1, max_length), mixture(components()) {}

    // By large steps until one carries light; target 0 if none does.
    PssState first_state(Rng& rng) {
        PssState state(layout);
        const LargeStep large(chart, techniques);
        for (int i = 0; i < 1000000 && !(state.target > 0); ++i) large.draw(state, rng);
        return state;
    }

    CoordinateLayout layout;
    Chart chart;
    TechniqueDistribution techniques;
    Mixture<PssState, Rng> mixture;

  private:
    std::vector<Mixture<PssState, Rng>::Component> components() {
        std::vector<Mixture<PssState, Rng>::Component> result;
        result.push_back({std::make_unique<LargeStep>(chart, techniques), 0.3});
        result.push_back({std::make_unique<SmallStep<KelemenKernel>>(chart, KelemenKernel()), 0.6});
        result.push_back({std::make_unique<TechniqueChange>(chart, techniques), 0.1});
        return result;
    }
};

}  // namespace keyhole
