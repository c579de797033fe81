// Finds out which moves suit a scene: before the first mutation that counts, sets of strategies compete in short runs
// from the same starting paths, and those that make less of their processor time drop out by and by; then weights and
// step sizes of the winner compete in the same way. The chains that follow know nothing of it but the mix, so they are
// exact.
#pragma once

#include <functional>

#include "render/bootstrap.h"
#include "render/render.h"

namespace keyhole {

// How long a race is: a share of the render, in processor seconds or (where the render is limited by a number)
// mutations.
struct RaceLength {
    double amount = 0;
    bool mutations = false;

    static RaceLength of(const RenderSettings& settings, int threads);  // resolved
};

struct RaceResult {
    Mix mix;  // as the one that raced, with the strategies of the winner
    TuningStatistics statistics;
};

// `settings` are resolved. `stop`: true ends the race with the best so far.
RaceResult race(const Scene& scene, const RenderSettings& settings, const CoordinateLayout& layout,
                const TechniqueDistribution& techniques, const Bootstrap& bootstrap, const RaceLength& length,
                const std::function<bool(double share)>& stop);

}  // namespace keyhole
