// Independent samples before the first mutation: they measure b and the energy of each technique, and start the chains.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include "base/rng.h"
#include "chain/running_mean.h"
#include "strategies/mmlt.h"

namespace keyhole {

// Streams of random numbers, so that no two uses share one.
enum class StreamUse : std::uint64_t { chain = 0, energies = 1, seeds = 2, resampling = 3 };
inline std::uint64_t stream(StreamUse use, std::uint64_t index) {
    return (static_cast<std::uint64_t>(use) << 60) | index;
}

struct Bootstrap {
    RunningMean b;                // integral of f* over raster area
    std::vector<PssState> seeds;  // one per chain, in proportion to the target; empty if nothing was found
    std::uint64_t non_finite = 0;
    std::uint64_t rays = 0;
};

// A quarter of the `samples` fits `techniques` to the energies, the rest estimates b and gives the seeds.
Bootstrap run_bootstrap(const Scene& scene, const CoordinateLayout& layout, TechniqueDistribution& techniques,
                        std::uint64_t samples, std::size_t chains, std::uint64_t seed);

}  // namespace keyhole
