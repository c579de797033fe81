// Mixes that a pool of strategies gives, for a race to choose from.
#pragma once

#include "strategies/mix.h"

namespace keyhole {

struct MixVariant {
    std::string name;
    Mix mix;
};

// The built-in mixes whose strategies all are in the pool, at their weights times the pool's and with the pool's
// parameters, without those that do not apply to the scene; the simplest first. The pool alone where there is none.
std::vector<MixVariant> sets_of(const Mix& pool, const Scene& scene);

// The mix with one weight or the sizes of one strategy three times as large or small.
std::vector<MixVariant> neighbours_of(const MixVariant& mix);

}  // namespace keyhole
