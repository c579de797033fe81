// When, and between which chains, paths are exchanged.
#pragma once

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "render/chain_worker.h"

namespace keyhole {

// A round after every `every` mutations of each chain. In a round each chain is in one pair at most, drawn anew; both
// are of one group and replicate, so that replicates stay independent, and of one length.
class Exchanges {
  public:
    Exchanges(std::uint64_t every, std::uint64_t seed, const std::vector<RunningChain>& chains);

    std::uint64_t left_of_round() const { return every_ - mutations_ % every_; }

    // After `mutations` more of each chain, no more than were left: makes the exchanges if the round is complete.
    // `worker()` gives the calling thread's worker.
    template <class Worker>
    void passed(std::uint64_t mutations, std::vector<RunningChain>& chains, const Worker& worker) {
        mutations_ += mutations;
        if (mutations_ % every_ == 0) exchange(chains, worker);
    }

  private:
    template <class Worker>
    void exchange(std::vector<RunningChain>& chains, const Worker& worker) {
        parallel_for(cells_.size(), [&](std::uint64_t c) {
            Rng rng(seed_, stream(StreamUse::exchange, mutations_ / every_ * cells_.size() + c));
            pair_up(cells_[c], chains, rng);
            const std::vector<std::uint32_t>& cell = cells_[c];
            for (std::size_t i = 0; i + 1 < cell.size(); i += 2)
                worker()->exchange(chains[cell[i]], chains[cell[i + 1]], rng);
        });
    }
    // Puts the chains of a cell into a random order, then those of one length together.
    static void pair_up(std::vector<std::uint32_t>& cell, const std::vector<RunningChain>& chains, Rng& rng);

    std::uint64_t every_, seed_, mutations_ = 0;
    std::vector<std::vector<std::uint32_t>> cells_;  // the chains of each group and replicate
};

}  // namespace keyhole
