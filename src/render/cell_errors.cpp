#include "render/cell_errors.h"

#include <limits>

namespace keyhole {

std::vector<Cells> cell_means(const ReplicateRecord& record) {
    std::vector<Cells> means;
    for (std::size_t r = 0; r < record.blocks[0].size(); ++r) {
        Cells sum(record.blocks[0][r].size());
        bool has_chains = false;
        for (std::size_t g = 0; g < record.blocks.size(); ++g) {
            const double mutations = record.mutations[g][r];
            if (!(mutations > 0)) continue;
            has_chains = true;
            RunningMean b;
            for (const RunningMean& replicate : record.b[g]) b.merge(replicate);
            for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += b.mean() * record.blocks[g][r][j] / mutations;
        }
        if (has_chains) means.push_back(std::move(sum));
    }
    return means;
}

Cells blocks_of(const Cells& cells, std::size_t fine) {
    constexpr std::size_t side = BlockGrid::usual_side;
    Cells blocks(side * side);
    for (std::size_t j = 0; j < cells.size(); ++j)
        blocks[j / (side * fine) / fine * side + j % (side * fine) / fine] += cells[j];
    return blocks;
}

Cells mean_of(const std::vector<std::vector<Cells>>& runs) {
    Cells mean(runs[0][0].size());
    for (const std::vector<Cells>& replicates : runs)
        for (const Cells& r : replicates)
            for (std::size_t j = 0; j < mean.size(); ++j)
                mean[j] += r[j] / static_cast<double>(replicates.size() * runs.size());
    return mean;
}

double squared_error(const std::vector<Cells>& replicates, const Cells& all) {
    constexpr double dark = 0.05;  // of the image's mean
    const auto n = static_cast<double>(replicates.size());
    double mean = 0;
    for (const double v : all) mean += v / static_cast<double>(all.size());
    if (n < 2 || !(mean > 0)) return std::numeric_limits<double>::infinity();
    double error = 0;
    for (std::size_t j = 0; j < all.size(); ++j) {
        double own = 0, square = 0;
        for (const Cells& r : replicates) own += r[j] / n;
        for (const Cells& r : replicates) square += (r[j] - own) * (r[j] - own);
        error += square / (n * (n - 1)) / (all[j] * all[j] + dark * dark * mean * mean);
    }
    return error / static_cast<double>(all.size());
}

}  // namespace keyhole
