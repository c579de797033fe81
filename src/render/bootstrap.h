// Independent samples before the first mutation: they measure b and the energy of each technique, and start the chains.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

#include "base/rng.h"
#include "chain/largest.h"
#include "chain/normalization.h"
#include "strategies/mix_states.h"

namespace keyhole {

// Streams of random numbers, so that no two uses share one.
enum class StreamUse : std::uint64_t { chain = 0, energies = 1, seeds = 2, resampling = 3, exchange = 4 };
inline std::uint64_t stream(StreamUse use, std::uint64_t index) {
    return (static_cast<std::uint64_t>(use) << 60) | index;
}

// A run is split into independent replicates, whose disagreement shows its errors. Each has an equal share of the
// bootstrap's samples, the chains that start from them, and what those find. So a replicate whose samples found more
// light has more chains.
inline constexpr std::size_t most_replicates = 16;
inline std::size_t replicate_count(const Mix& mix) {
    // Chains exchange paths inside of a replicate only.
    const int chains = mix.exchange_every > 0 ? std::max(1, mix.chain_count / 2) : mix.chain_count;
    return std::min(most_replicates, static_cast<std::size_t>(chains));
}

// How many of the largest estimates of b are kept, to see whether it rests on them.
inline constexpr std::size_t heaviest = 5;

struct ChainSeed {
    PssState state;
    std::uint32_t replicate = 0;
};

// Chains that share a target and its normalisation: all chains where lengths are free, those of one length where each
// chain keeps its own. The image is the sum over groups of b / (mutations of the group) times the group's film.
struct ChainGroup {
    int length = 0;  // of its paths; 0: any
    BridgeFunction bridge;
    std::vector<Normalization> b;  // by replicate: integral of f* over raster area, of these paths
    Largest<heaviest> largest;     // of the samples' weights
    std::vector<ChainSeed> seeds;  // one per chain, in proportion to the target but for those that are moved
    double moved_starts = 0;       // share of them (Mix::most_starts)

    Normalization all() const;  // of all replicates
};

struct Bootstrap {
    std::vector<ChainGroup> groups;  // those in which a path with light was found
    std::uint64_t non_finite = 0;
    std::uint64_t rays = 0;
};

// A quarter of the mix's samples fits `techniques` to the energies, the rest estimates b and gives the seeds. `mix` is
// resolved. Throws std::invalid_argument if there are fewer chains than lengths that need one each.
Bootstrap run_bootstrap(const Scene& scene, const CoordinateLayout& layout, TechniqueDistribution& techniques,
                        const Mix& mix);

}  // namespace keyhole
