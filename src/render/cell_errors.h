// What runs know of the image's cells, by the disagreement of their replicates.
#pragma once

#include "render/error_statistics.h"

namespace keyhole {

using Cells = std::vector<double>;  // row by row, as many rows as columns

// The light of the cells of the record's grid as each replicate has it, up to a factor that all have in common. The b
// of a group is that of all replicates.
std::vector<Cells> cell_means(const ReplicateRecord& record);

// The usual blocks, of `fine` x `fine` cells each.
Cells blocks_of(const Cells& cells, std::size_t fine);

// Over the replicates of each run, then over the runs.
Cells mean_of(const std::vector<std::vector<Cells>>& runs);

// Of the replicates' mean: the mean over cells of its squared standard error, relative to the cells of `all`. Dark
// cells count less. Infinite for fewer than two replicates, or if all is dark.
double squared_error(const std::vector<Cells>& replicates, const Cells& all);

}  // namespace keyhole
