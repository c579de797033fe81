// A mix that names strategies it does not use.
#pragma once

#include <algorithm>

#include "strategies/mix_file.h"

namespace keyhole {

// The mix with all other strategies of fused-all at weight zero.
inline Mix with_unused(Mix mix) {
    for (MixStrategy s : builtin_mix("fused-all").strategies) {
        s.weight = 0;
        const bool known = std::any_of(mix.strategies.begin(), mix.strategies.end(),
                                       [&](const MixStrategy& other) { return other.label == s.label; });
        if (!known) mix.strategies.push_back(std::move(s));
    }
    return mix;
}

}  // namespace keyhole
