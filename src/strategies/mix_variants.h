// Mixes that a pool of strategies gives, for a race to choose from.
#pragma once

#include <functional>

#include "strategies/mix.h"

namespace keyhole {

struct MixVariant {
    std::string name;
    Mix mix;
};

// Of the built-in mixes the strategies that apply, at their weights times the pool's and with the pool's parameters,
// where all of them are in the pool; first the one that is far behind the best in no scene (docs/benchmarks.md). The
// pool alone where there is none. `easy`: whether independent samples find the light.
std::vector<MixVariant> sets_of(const Mix& pool, bool easy, const std::function<bool(const MixStrategy&)>& applies);

// The mix with one weight or the sizes of one strategy three times as large or small.
std::vector<MixVariant> neighbours_of(const MixVariant& mix);

}  // namespace keyhole
