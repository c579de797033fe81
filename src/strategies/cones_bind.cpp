#include "strategies/cones_bind.h"

#include "strategies/perturbation.h"

namespace keyhole {

bool cones_bind(const MixStrategy& strategy, const Scene& scene, const std::vector<const PssState*>& paths) {
    constexpr double share_that_counts = 0.01;
    const double greatest = number(strategy.parameters, "tau-max");
    const std::unique_ptr<const StepSize> cones = strategy.info->cones(scene, strategy.parameters);
    int edges = 0, bound = 0;
    for (const PssState* state : paths) {
        const std::span<const Vertex> x = state->path.x();
        for (std::size_t i = 0; i + 1 < x.size(); ++i) {
            if (x[i].infinite) continue;
            ++edges;
            bound += (*cones)(x[i], x[i + 1]).r_max < greatest;
        }
    }
    return bound > share_that_counts * edges;
}

}  // namespace keyhole
