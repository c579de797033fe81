// What runs know of the image's cells, by the disagreement of their replicates.
#pragma once

#include "render/error_statistics.h"

namespace keyhole {

using Cells = std::vector<double>;  // row by row, as many rows as columns

// The light of the cells of the record's grid as each replicate has it, up to a factor that all have in common. The b
// of a group is that of all replicates.
std::vector<Cells> cell_means(const ReplicateRecord& record);

// Sums of `by` x `by` cells each.
Cells coarser(const Cells& cells, std::size_t by);

// Over the replicates of each run, then over the runs.
Cells mean_of(const std::vector<std::vector<Cells>>& runs);

// Of the replicates' mean: the mean over cells of its squared standard error, relative to what the cells of one of
// 4 x 4 parts of the image have on average by `all`, and to the image's mean in darker parts. Not to the cells
// themselves: of these, `all` may know no more than what is to be judged, and who alone found light somewhere would
// seem to err there. Infinite for fewer than two replicates, or if all is dark.
double squared_error(const std::vector<Cells>& replicates, const Cells& all);

// Standard error of log(squared_error(a) / squared_error(b)), by the jackknife over replicates, of which both have as
// many. Infinite for fewer than three, or where one without a replicate has no error.
double error_of_log_ratio(const std::vector<Cells>& a, const std::vector<Cells>& b, const Cells& all);

}  // namespace keyhole
