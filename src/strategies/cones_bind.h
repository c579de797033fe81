// Whether cones make a difference in a scene.
#pragma once

#include "strategies/mix.h"

namespace keyhole {

// False if the steps of the strategy (one with cones) are as large as its greatest cone about nearly all edges of the
// paths: then there is nothing to avoid, and cones only take time. `paths` keep their vertices.
bool cones_bind(const MixStrategy& strategy, const Scene& scene, const std::vector<const PssState*>& paths);

}  // namespace keyhole
