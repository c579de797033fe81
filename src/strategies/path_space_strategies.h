// The registry's entries of moves in path space.
#pragma once

#include "strategies/registry.h"

namespace keyhole {

// In the order of the documentation.
std::vector<StrategyInfo> path_space_strategies();

}  // namespace keyhole
