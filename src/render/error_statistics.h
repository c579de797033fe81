// How far to trust a run of chains: errors, effective samples and warnings, from what its replicates recorded.
#pragma once

#include "render/block_record.h"
#include "render/chain_worker.h"
#include "render/render.h"
#include "render/replicate_errors.h"

namespace keyhole {

// Everything a run has recorded, by groups and replicates.
struct ReplicateRecord {
    explicit ReplicateRecord(const RasterWindow& w) : window(w) {}

    RasterWindow window;
    std::vector<std::vector<Normalization>> b;  // from the bootstrap and from the chains
    std::vector<std::vector<double>> mutations;
    std::vector<std::vector<BlockSums>> blocks;  // with what the chains still hold
    std::vector<std::vector<ObservableMoments>> states;
    std::vector<Largest<heaviest>> largest;  // by group
    std::vector<ObservableJumps> jumps;      // by strategy
};

// Sets statistics.errors and the mixing of its strategies, whose counts are known already, and adds to its warnings.
// `over_time`: the same blocks, which say how much the replicates disagree.
void report_errors(const ReplicateRecord& record, const BlockRecord& over_time, RenderStatistics& statistics);

}  // namespace keyhole
