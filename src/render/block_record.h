// The light of the image's blocks by replicate, in all and over time.
#pragma once

#include <cstdint>
#include <vector>

#include "render/block_sums.h"

namespace keyhole {

// Time is cut into batches of equally many mutations of each chain, whose length doubles as the run goes on: there are
// always between max_batches / 2 and max_batches of them (after a start with fewer).
class BlockRecord {
  public:
    static constexpr std::size_t max_batches = 8;
    using ByReplicate = std::vector<BlockSums>;

    BlockRecord(std::size_t groups, std::size_t replicates, std::size_t blocks)
        : totals_(groups, ByReplicate(replicates, BlockSums(blocks))), current_(replicates, BlockSums(blocks)) {}

    // Mutations of each chain before the present batch ends: all chains must stop there.
    std::uint64_t left_of_batch() const { return batch_length_ - filled_; }

    // Adds what a worker collected since the last time, by group and replicate, and clears it.
    void take(std::vector<ByReplicate>& collected);

    // All was taken that `mutations` more of each chain collected.
    void passed(std::uint64_t mutations);

    const std::vector<ByReplicate>& totals() const { return totals_; }  // by group
    // The share of the image's light that lies in blocks where the replicates' disagreement() exceeds what is to be
    // expected if chains have the autocorrelation time `memory`. Negative: not known, as there are too few batches.
    double disagreeing_light(double memory) const;

  private:
    std::vector<ByReplicate> totals_;
    std::vector<ByReplicate> batches_;  // of all groups
    ByReplicate current_;
    std::uint64_t batch_length_ = 1, filled_ = 0;
};

}  // namespace keyhole
